//! The contact estimators that a policy can select.

use serde::{Deserialize, Serialize};

/// The kind of a contact estimator, selected by a policy for each whisker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ContactEstimatorKind {
    /// Uses the base angle alone, as the baseline does. It is exact on a surface parallel to the heading.
    OneChannel,
    /// Filters base angles and poses with a model of a tip that slides along a surface.
    #[default]
    Sliding,
    /// Uses the moment and the shear at the base. The rig must measure the shear. It also locates contacts of the
    /// shaft.
    MomentAndShear,
    /// Uses the base angle as a polynomial in the tip position and follows its gradient from reading to reading.
    Recursive,
    /// Uses the base angle alone, by a polynomial for the tip position with the range of the baseline's (section 3.3 of
    /// its report).
    Polynomial,
    /// Is an ideal sensor of the tip position. Only a simulator can supply its readings.
    Truth,
}

impl ContactEstimatorKind {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::OneChannel, Self::Sliding, Self::MomentAndShear, Self::Recursive, Self::Polynomial, Self::Truth];

    /// The keyword of this kind in a policy.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OneChannel => "one_channel",
            Self::Sliding => "sliding",
            Self::MomentAndShear => "moment_and_shear",
            Self::Recursive => "recursive",
            Self::Polynomial => "polynomial",
            Self::Truth => "truth",
        }
    }

    /// True for an ideal sensor, whose readings only a simulator can supply.
    #[must_use]
    pub const fn is_ideal(self) -> bool {
        matches!(self, Self::Truth)
    }

    /// Returns the kind with this keyword.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
