//! The length of the platform's path.

use crate::run::TickRecord;
use vibrissa_world::geometry::Point2;

/// The length (m) of the path of the platform's centre of mass over some ticks, as a polyline. Ticks without a pose are
/// skipped.
#[must_use]
pub fn body_path(ticks: &[TickRecord]) -> f64 {
    let mut before: Option<Point2> = None;
    let places = ticks.iter().filter(|tick| tick.body.is_finite()).map(|tick| tick.body.position);
    // An empty `sum` is negative zero.
    places.fold(0.0, |length, place| length + before.replace(place).map_or(0.0, |before| (place - before).norm()))
}
