//! Errors of measured poses, from the differences of measured and expected motions.

use super::platform_motion::Motion;
use super::robust_variance::RobustVariance;

/// The standard deviations of the errors of measured poses.
///
/// Differences of measured and expected motions are summed. The second difference of these sums does not depend on a
/// constant speed, such as that by which a bent whisker pushes the platform.
#[derive(Debug, Clone)]
pub(super) struct PoseNoise {
    /// Sums of the differences at the newest ticks, and their number since the last gap.
    sums: [Motion; 2 * LAG + 1],
    /// Expected motions of these ticks.
    expected: [Motion; 2 * LAG + 1],
    newest: usize,
    count: usize,
    /// Variances of the position (m²) and of the heading (rad²).
    position: RobustVariance,
    heading: RobustVariance,
}

/// The standard deviations of the errors of a measured pose.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct PoseDeviation {
    /// Of each coordinate of the position (m).
    pub(super) position: f64,
    /// Of the heading (rad).
    pub(super) heading: f64,
}

/// Ticks between the sums of a second difference. For an error with a correlation time of 1 s, at 30 Hz, it then has the
/// standard deviation of the error.
const LAG: usize = 8;
/// Error of the time of an expected motion, as a share of a tick.
const SHARE_OF_TICK: f64 = 0.15;
/// Errors of the position (m) and of the heading (rad) that have no effect. Bent whiskers push a platform with exact poses
/// by nearly as much.
const LEAST: (f64, f64) = (3e-5, 2.5e-4);

impl PoseNoise {
    /// Creates the measurement.
    pub(super) fn new() -> Self {
        Self {
            sums: [Motion::zeros(); 2 * LAG + 1],
            expected: [Motion::zeros(); 2 * LAG + 1],
            newest: 0,
            count: 0,
            position: RobustVariance::new(LEAST.0),
            heading: RobustVariance::new(LEAST.1),
        }
    }

    /// Adds the expected motion of a tick, and the difference of the measured motion from it. `None` if one of them is
    /// unknown.
    pub(super) fn take(&mut self, motions: Option<[Motion; 2]>) {
        let Some([expected, difference]) = motions else {
            self.count = 0;
            return;
        };
        let before = self.sums[self.newest];
        self.newest = (self.newest + 1) % self.sums.len();
        self.sums[self.newest] = before + difference;
        self.expected[self.newest] = expected;
        self.count = (self.count + 1).min(self.sums.len());
        if self.count == self.sums.len() {
            let second = self.second_difference(&self.sums);
            // The expected motion is late or early by a share of a tick.
            let by_time = SHARE_OF_TICK * self.second_difference(&self.expected);
            if by_time.xy().norm() < 0.5 * LEAST.0 {
                self.position.take(second.x);
                self.position.take(second.y);
            }
            if by_time.z.abs() < 0.5 * LEAST.1 {
                self.heading.take(second.z);
            }
        }
    }

    /// The second difference of the values of the newest ticks.
    fn second_difference(&self, values: &[Motion; 2 * LAG + 1]) -> Motion {
        let ago = |ticks: usize| values[(self.newest + values.len() - ticks) % values.len()];
        ago(0) - 2.0 * ago(LAG) + ago(2 * LAG)
    }

    /// The errors, 0 unless significant.
    pub(super) fn deviation(&self) -> PoseDeviation {
        PoseDeviation {
            position: self.position.beyond(LEAST.0).unwrap_or(0.0),
            heading: self.heading.beyond(LEAST.1).unwrap_or(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::robust_variance::tests::normals;
    use super::*;
    use crate::math;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn a_wander_is_found_on_a_platform_that_is_pushed(
            values in normals(3600), position in 5e-5..5e-4_f64, heading in 5e-4..5e-3_f64, push in -1e-2..1e-2_f64,
        ) {
            let decay = math::exp(-1.0 / 30.0);
            let mut noise = PoseNoise::new();
            let mut error = Motion::zeros();
            for values in values.chunks(3) {
                let scale = Motion::new(position, position, heading) * (1.0 - decay * decay).sqrt();
                let next = error * decay + scale.component_mul(&Motion::from_column_slice(values));
                noise.take(Some([Motion::zeros(), next - error + Motion::new(push, -push, push) / 30.0]));
                error = next;
            }
            let found = noise.deviation();
            prop_assert!((0.6..1.6).contains(&(found.position / position)), "{found:?}");
            prop_assert!((0.5..1.8).contains(&(found.heading / heading)), "{found:?}");
        }
    }

    #[test]
    fn exact_poses_have_no_errors() {
        let mut noise = PoseNoise::new();
        for _ in 0..1000 {
            noise.take(Some([Motion::zeros(), Motion::new(1e-5, 2e-5, 1e-4)]));
        }
        assert_eq!(noise.deviation(), PoseDeviation::default());
    }
}
