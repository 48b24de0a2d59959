//! The response of perception to the bends of whiskers.

use super::tip::whiskers;
use crate::run::{TickRecord, Trace};
use vibrissa_runtime::geometry::wrap;
use vibrissa_runtime::math;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_world::geometry::Point2;

/// The least bend (rad) that counts: the angle at the base between the direction of the true tip and that of the straight
/// shaft. Vibrations stay below it.
pub const BENT: f64 = 0.1;

/// The time (s) for which a whisker must be bent, so that its response can be judged.
pub const BENT_TIME: f64 = 0.5;

/// Below this response, a whisker seems dead or insensitive. The errors of an array that nobody has calibrated change the
/// response by less than a fifth. A reading that does not depend on the whisker gives 0.
pub const LEAST_RESPONSE: f64 = 0.5;

/// How perception follows the bends of a whisker in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// Time (s) for which the simulated whisker was bent by more than [`BENT`].
    pub bent_time: f64,
    /// The slope of the perceived bend over the true one, by least squares over all ticks. 1 for a perfect sensor. A
    /// constant error changes nothing. `None` if the whisker was bent for less than [`BENT_TIME`].
    pub slope: Option<f64>,
}

impl Response {
    /// True if the whisker seems dead or insensitive.
    #[must_use]
    pub fn is_dead(&self) -> bool {
        self.slope.is_some_and(|slope| slope < LEAST_RESPONSE)
    }
}

/// The responses of the whiskers of `rig` in a run. Whiskers without a true tip are left out.
#[must_use]
pub fn responses(trace: &Trace, rig: &Rig) -> Vec<Response> {
    let of = |whisker: usize| {
        let name = trace.whiskers.get(whisker)?;
        let fitted = rig.whiskers.iter().find(|fitted| fitted.name == *name)?;
        // A whisker without a reading shows no bend.
        let bends = trace.ticks.iter().filter_map(|tick| {
            let perceived = tick.whiskers[whisker].contact.tip_world.map_or(0.0, |tip| bend(tick, fitted, tip));
            Some((bend(tick, fitted, tick.whiskers[whisker].tip_end?), perceived))
        });
        let bends: Vec<_> = bends.filter(|(bend, perceived)| bend.is_finite() && perceived.is_finite()).collect();
        let bent = bends.iter().filter(|(bend, _)| bend.abs() > BENT).count();
        let bent_time = bent as f64 * trace.period;
        let slope = if bent_time < BENT_TIME { None } else { slope(&bends) };
        (!bends.is_empty()).then_some(Response { whisker, bent_time, slope })
    };
    whiskers(trace).filter_map(of).collect()
}

/// The angle (rad) at the base of a whisker between the direction of a tip and that of the straight shaft.
fn bend(tick: &TickRecord, whisker: &Whisker, tip_world: Point2) -> f64 {
    let tip = tick.body.point_from_world(tip_world) - whisker.base_body;
    wrap(math::atan2(tip.y, tip.x) - whisker.direction_body)
}

/// The slope of the second number over the first, by least squares. `None` if the first is constant.
fn slope(pairs: &[(f64, f64)]) -> Option<f64> {
    let count = pairs.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| pairs.iter().map(part).sum::<f64>() / count;
    let (first, second) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let square: f64 = pairs.iter().map(|pair| math::square(pair.0 - first)).sum();
    let product: f64 = pairs.iter().map(|pair| (pair.0 - first) * (pair.1 - second)).sum();
    (square > 0.0).then(|| product / square)
}
