//! The tip models that a policy can have its whiskers perceived by.

use serde::{Deserialize, Serialize};

/// A tip model: how the place of a whisker's tip is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TipModelKind {
    /// From the base angle alone, as the thesis does: exact on a surface parallel to the heading.
    OneChannel,
    /// From base angles and poses one after the other, by what sliding along a surface allows.
    #[default]
    Sliding,
}

impl TipModelKind {
    /// Every tip model.
    pub const ALL: [Self; 2] = [Self::OneChannel, Self::Sliding];

    /// The word that stands for it in a policy.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OneChannel => "one_channel",
            Self::Sliding => "sliding",
        }
    }

    /// The one with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
