//! An ideal sensor of tip positions.

use super::{Observed, World};
use crate::geometry::{ContourSet, Point2};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Sample, TrueTip};

/// Largest gap (m) between a tip and a surface that it touches. Chords of the simulated outline deviate from the exact
/// one, and a sliding tip vibrates.
const GAP: f64 = 2e-5;

/// Adds true tips to the samples of a `world` with this rig and these exact surfaces, for the contact estimator `truth`.
///
/// It is the only place at which true tips enter samples. A trial uses it only if true tips are asked for.
#[must_use]
pub fn with_true_tips(world: Box<dyn World>, rig: &Rig, surfaces: ContourSet) -> impl World + use<> {
    // Radius of the tip of every whisker of the rig (m).
    let radii: Vec<f64> = rig.whiskers.iter().map(|whisker| whisker.shaft.radius_at(1.0)).collect();
    Observed::new(world, move |world: &dyn World, samples: &mut Vec<Sample>| {
        // A world knows its tips at the newest sample, which is the one that a tick uses.
        if let Some(newest) = samples.last_mut() {
            for (whisker, (reading, &radius)) in newest.whiskers.iter_mut().zip(&radii).enumerate() {
                reading.true_tip = Some(true_tip(&surfaces, world.tip(whisker), radius));
            }
        }
    })
}

/// The point nearest to the surfaces of a tip of this `radius` (m) whose axis ends at `end` (m, world frame).
fn true_tip(surfaces: &ContourSet, end: Point2, radius: f64) -> TrueTip {
    let nearest = surfaces.nearest(end);
    let inwards = (nearest.point - end).try_normalize(0.0).unwrap_or_default();
    TrueTip { point_world: end + radius * inwards, touches: nearest.distance <= radius + GAP }
}
