//! The distance of a run from the axis of a tunnel.

use crate::run::{TickRecord, Trace};
use vibrissa_world::geometry::{Point2, TunnelAxis, Vector2};

use super::tip::is_finite;
use super::{Moments, Statistics};

/// The distance of the estimated midpoints from the axis of the tunnel (m): the baseline's axis error (section 5.3).
///
/// A midpoint is in the middle between the tips that a tick recorded on the left and on the right of the body. Several tips
/// on a side are averaged. Only ticks count in which both walls were recorded, starting with the first. The transition
/// at the start is part of the baseline's figure. With several tunnels, the nearest axis counts. Midpoints before the
/// beginning and beyond the end of all axes do not count.
///
/// Returns `None` without midpoints.
#[must_use]
pub fn axis_error(trace: &Trace, axes: &[TunnelAxis]) -> Option<Moments> {
    let errors = midpoints(trace, axes).map(|midpoint| midpoint.error);
    Statistics::of(errors.collect()).map(|errors| Moments { mean: errors.mean(), std: errors.std() })
}

/// An estimated midpoint of a tunnel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Midpoint {
    /// Index of its tick in the trace.
    pub tick: usize,
    /// Its position (m, world frame).
    pub point_world: Point2,
    /// Its distance from the nearest axis (m).
    pub error: f64,
}

/// The midpoints that count for the [axis error](axis_error), in the order of their ticks.
pub fn midpoints(trace: &Trace, axes: &[TunnelAxis]) -> impl Iterator<Item = Midpoint> {
    let nearest = |midpoint| axes.iter().filter_map(|axis| axis.distance(midpoint)).min_by(f64::total_cmp);
    trace.ticks.iter().enumerate().filter_map(move |(tick, record)| {
        let point_world = midpoint(record)?;
        Some(Midpoint { tick, point_world, error: nearest(point_world)? })
    })
}

/// The midpoint of the tips that a tick recorded on both sides of the body (m, world frame).
fn midpoint(tick: &TickRecord) -> Option<Point2> {
    if !tick.body.is_finite() {
        return None;
    }
    let mut sides = [(Vector2::zeros(), 0.0); 2];
    for tip_world in tick.tips().filter(is_finite) {
        let is_left = tick.body.point_from_world(tip_world).y > 0.0;
        let (sum, count) = &mut sides[usize::from(is_left)];
        *sum += tip_world.coords;
        *count += 1.0;
    }
    let [(right, of_right), (left, of_left)] = sides;
    (of_right > 0.0 && of_left > 0.0).then(|| Point2::from(0.5 * (right / of_right + left / of_left)))
}
