//! How far a run kept from the middle of a tunnel.

use super::tip::is_finite;
use super::{Spread, Statistics};
use crate::geometry::{ContourSet, Point2};
use crate::run::Trace;

/// The thesis's axis error (section 5.3) in metres: the distance from the tunnel's `axis` of the estimated midpoints. There is
/// one for every tick in which just two whiskers recorded a tip, in the middle between the two. `None` if there is none.
#[must_use]
pub fn axis_error(trace: &Trace, axis: &ContourSet) -> Option<Spread> {
    let midpoint = |tips: &[Option<Point2>]| {
        let mut tips = tips.iter().flatten().filter(|tip| is_finite(tip));
        let (first, second) = (tips.next()?, tips.next()?);
        tips.next().is_none().then(|| nalgebra::center(first, second))
    };
    let midpoints = trace.ticks.iter().filter_map(|tick| midpoint(&tick.tips));
    let statistics = Statistics::of(midpoints.map(|midpoint| axis.nearest(midpoint).distance).collect())?;
    Some(Spread { mean: statistics.mean(), std: statistics.std() })
}
