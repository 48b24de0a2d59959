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
/// Errors of the position (m) and of the heading (rad) that the model of the contacts covers.
const LEAST: (f64, f64) = (1.5e-5, 1.5e-4);

impl PoseNoise {
    /// Creates the measurement.
    pub(super) fn new() -> Self {
        Self {
            sums: [Motion::zeros(); 2 * LAG + 1],
            newest: 0,
            count: 0,
            position: RobustVariance::new(LEAST.0),
            heading: RobustVariance::new(LEAST.1),
        }
    }

    /// Adds the difference of the measured and the expected motion of a tick. `None` if one of them is unknown.
    pub(super) fn take(&mut self, difference: Option<Motion>) {
        let Some(difference) = difference else {
            self.count = 0;
            return;
        };
        let before = self.sums[self.newest];
        self.newest = (self.newest + 1) % self.sums.len();
        self.sums[self.newest] = before + difference;
        self.count = (self.count + 1).min(self.sums.len());
        if self.count == self.sums.len() {
            let ago = |ticks: usize| self.sums[(self.newest + self.sums.len() - ticks) % self.sums.len()];
            let second = ago(0) - 2.0 * ago(LAG) + ago(2 * LAG);
            self.position.take(second.x);
            self.position.take(second.y);
            self.heading.take(second.z);
        }
    }

    /// The errors, 0 unless significant.
    pub(super) fn deviation(&self) -> PoseDeviation {
        PoseDeviation {
            position: self.position.beyond(LEAST.0).unwrap_or(0.0),
            heading: self.heading.beyond(LEAST.1).unwrap_or(0.0),
        }
    }
}
