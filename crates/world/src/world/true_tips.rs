//! An ideal sensor of tip positions.

use super::{Fault, OutOfPlane, Posture, World};
use crate::geometry::{ContourSet, Point2};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample, TrueTip};

/// Largest gap (m) between a tip and a surface that it touches. Chords of the simulated outline deviate from the exact
/// one, and a sliding tip vibrates.
const GAP: f64 = 2e-5;

/// A world whose samples have the true tips, for the contact estimator `truth`.
///
/// It is the only place at which true tips enter samples. A trial uses it only if true tips are asked for.
pub struct TrueTips {
    world: Box<dyn World>,
    surfaces: ContourSet,
    /// Radius of the tip of every whisker of the rig (m).
    radii: Vec<f64>,
    samples: Vec<Sample>,
}

impl TrueTips {
    /// Adds true tips to the samples of a `world` with this rig and these exact surfaces.
    #[must_use]
    pub fn new(world: Box<dyn World>, rig: &Rig, surfaces: ContourSet) -> Self {
        let radii = rig.whiskers.iter().map(|whisker| whisker.shaft.radius_at(1.0)).collect();
        Self { world, surfaces, radii, samples: Vec::new() }
    }
}

/// The point nearest to the surfaces of a tip of this `radius` (m) whose axis ends at `end` (m, world frame).
fn true_tip(surfaces: &ContourSet, end: Point2, radius: f64) -> TrueTip {
    let nearest = surfaces.nearest(end);
    let inwards = (nearest.point - end).try_normalize(0.0).unwrap_or_default();
    TrueTip { point_world: end + radius * inwards, touches: nearest.distance <= radius + GAP }
}

impl World for TrueTips {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.samples.clear();
        self.samples.extend_from_slice(self.world.advance(command)?);
        // A world knows its tips at the newest sample, which is the one that a tick uses.
        if let Some(newest) = self.samples.last_mut() {
            for (whisker, (reading, &radius)) in newest.whiskers.iter_mut().zip(&self.radii).enumerate() {
                reading.true_tip = Some(true_tip(&self.surfaces, self.world.tip(whisker), radius));
            }
        }
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.world.body_touches()
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.world.snapped_off(whisker)
    }

    fn out_of_plane(&self, whisker: usize) -> Option<OutOfPlane> {
        self.world.out_of_plane(whisker)
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }

    fn posture(&self) -> Option<Posture> {
        self.world.posture()
    }
}
