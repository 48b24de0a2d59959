//! The bend of a whisker whose material creeps.

use crate::math;
use crate::rig::{Sensing, Whisker};

/// The static base angle for the bend that a whisker has now.
///
/// The moment in a viscous shaft is `EI (κ + T κ')` with the curvature `κ` and the damping `T` of the material relative to its
/// stiffness. So while the shaft moves, the moment at its base, which is what the sensor measures, is not that of its shape. In small
/// deflections a reading is `a + T a'` for the base angle `a` that the same shape has at rest. This filter solves that equation. In
/// the air, where the reading is zero, the shape creeps back with the time constant `T`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Creep {
    /// Share of a difference that is left after a sample.
    left: f64,
    /// The static base angle (rad).
    base_angle: f64,
}

impl Creep {
    /// Creates the filter of `whisker` at rest. `None` if its material follows within a sample, so that samples cannot show a
    /// difference.
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Option<Self> {
        let (damping, period) = (whisker.vibrating().shaft.damping, sensing.sample_rate.recip());
        (damping > period).then(|| Self { left: math::exp(-period / damping), base_angle: 0.0 })
    }

    /// Adds a reading (rad), and returns the static base angle (rad) for the bend.
    pub(super) fn take(&mut self, reading: f64) -> f64 {
        self.base_angle = reading + (self.base_angle - reading) * self.left;
        self.base_angle
    }

    /// The static base angle (rad) at the newest reading.
    pub(super) fn base_angle(&self) -> f64 {
        self.base_angle
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::rig::Rig;

    proptest! {
        #[test]
        fn the_base_angle_at_rest_is_found_from_the_moment_of_a_viscous_shaft(
            damping in 0.01..1.0_f64, waves in prop::collection::vec((1e-5..1e-4_f64, 0.5..12.0_f64), 1..4),
        ) {
            let rig = Rig::default();
            let mut whisker = rig.whiskers[0].clone();
            whisker.shaft.damping = damping;
            let mut creep = Creep::new(&whisker, &rig.sensing).ok_or_else(|| TestCaseError::fail("it creeps"))?;
            let period = rig.sensing.sample_rate.recip();
            let sum = |of: &dyn Fn(f64, f64) -> f64| waves.iter().map(|&(size, rate)| of(size, rate)).sum::<f64>();
            let (mut worst, size) = (0.0_f64, sum(&|size, _| size));
            for index in 1..3000 {
                let time = f64::from(index) * period;
                let at_rest = sum(&|size, rate| size * (1.0 - math::cos(rate * time)));
                let growth = sum(&|size, rate| size * rate * math::sin(rate * time));
                let found = creep.take(at_rest + damping * growth);
                worst = math::max(worst, (found - at_rest).abs());
            }
            // A reading holds for a whole sample period.
            prop_assert!(worst < 0.03 * size, "{worst} rad of {size} rad");
        }
    }

    #[test]
    fn a_shaft_that_follows_within_a_sample_does_not_creep() {
        let rig = Rig::default();
        assert!(Creep::new(&rig.whiskers[0], &rig.sensing).is_none());
    }
}
