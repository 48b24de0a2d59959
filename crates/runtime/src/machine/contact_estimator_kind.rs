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
}

impl ContactEstimatorKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::OneChannel, Self::Sliding, Self::MomentAndShear, Self::Recursive];

    /// The keyword of this kind in a policy.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OneChannel => "one_channel",
            Self::Sliding => "sliding",
            Self::MomentAndShear => "moment_and_shear",
            Self::Recursive => "recursive",
        }
    }

    /// Returns the kind with this keyword.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
