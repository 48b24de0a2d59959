//! Contours of a policy.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

/// Number and spacing of the keypoints to which a local contour is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Keypoints {
    /// Number of keypoints, within [`COUNT`](Self::COUNT).
    pub count: usize,
    /// Minimum distance between two keypoints (m), within [`SPACING`](Self::SPACING).
    pub spacing: f64,
}

impl Keypoints {
    /// The numbers of keypoints for which a parabola can be fitted in a bounded time.
    pub const COUNT: RangeInclusive<usize> = 3..=16;
    /// The distances (m) for which the fit is well conditioned.
    pub const SPACING: RangeInclusive<f64> = 1e-4..=0.02;

    /// True if number and spacing are within their ranges.
    #[must_use]
    pub fn are_valid(&self) -> bool {
        Self::COUNT.contains(&self.count) && Self::SPACING.contains(&self.spacing)
    }
}

impl Default for Keypoints {
    /// Seven keypoints that are at least 1 mm apart.
    fn default() -> Self {
        Self { count: 7, spacing: 1e-3 }
    }
}

/// A contour through positions that the policy records itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PositionContour {
    /// Its name in the policy.
    pub name: String,
    /// Its keypoints.
    pub keypoints: Keypoints,
}
