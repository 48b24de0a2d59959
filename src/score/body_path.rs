//! How far the platform went.

use crate::geometry::Point2;
use crate::run::TickRecord;

/// The length (m) of the path of the platform's centre of mass over some ticks: straight from tick to tick. A tick without a
/// pose is left out, so that the path goes straight across it.
#[must_use]
pub fn body_path(ticks: &[TickRecord]) -> f64 {
    let mut before: Option<Point2> = None;
    let places = ticks.iter().filter(|tick| tick.body.is_finite()).map(|tick| tick.body.position);
    // Not `sum`, whose nothing is negative zero.
    places.fold(0.0, |length, place| length + before.replace(place).map_or(0.0, |before| (place - before).norm()))
}
