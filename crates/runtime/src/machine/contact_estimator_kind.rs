//! The tip models that a policy can have its whiskers perceived by.

use serde::{Deserialize, Serialize};

/// A tip model: how the place of a whisker's tip is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ContactEstimatorKind {
    /// From the base angle alone, as the thesis does: exact on a surface parallel to the heading.
    OneChannel,
    /// From base angles and poses one after the other, by what sliding along a surface allows.
    #[default]
    Sliding,
    /// From the moment and the shear at the base, where the rig measures the latter: finds a touch on the shaft, too.
    MomentAndShear,
    /// From the base angle as a polynomial in the tip's place, step by step along its gradient.
    Recursive,
}

impl ContactEstimatorKind {
    /// Every tip model.
    pub const ALL: [Self; 4] = [Self::OneChannel, Self::Sliding, Self::MomentAndShear, Self::Recursive];

    /// The word that stands for it in a policy.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OneChannel => "one_channel",
            Self::Sliding => "sliding",
            Self::MomentAndShear => "moment_and_shear",
            Self::Recursive => "recursive",
        }
    }

    /// The one with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
