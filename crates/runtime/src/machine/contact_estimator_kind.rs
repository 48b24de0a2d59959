//! The contact estimators that a policy can select.

use serde::{Deserialize, Serialize};

crate::kinds! {
    /// The kind of a contact estimator, selected by a policy for each whisker.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum ContactEstimatorKind,
    /// The keyword of this kind in a policy.
    fn name {
        /// Uses the base angle alone, as the baseline does. It is exact on a surface parallel to the heading.
        OneChannel = "one_channel",
        /// Filters base angles and poses with a model of a tip that slides along a surface.
        #[default]
        Sliding = "sliding",
        /// Uses the moment and the shear at the base. The rig must measure the shear. It also locates contacts of the
        /// shaft.
        MomentAndShear = "moment_and_shear",
        /// Uses the base angle as a polynomial in the tip position and follows its gradient from reading to reading.
        Recursive = "recursive",
        /// Uses the base angle alone, by a polynomial for the tip position with the range of the baseline's (section 3.3 of
        /// its report).
        Polynomial = "polynomial",
        /// Is an ideal sensor of the tip position. Only a simulator can supply its readings.
        Truth = "truth",
    }
}

impl ContactEstimatorKind {
    /// True for an ideal sensor, whose readings only a simulator can supply.
    #[must_use]
    pub const fn is_ideal(self) -> bool {
        matches!(self, Self::Truth)
    }
}
