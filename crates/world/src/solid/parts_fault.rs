//! The reasons why MuJoCo cannot simulate a solid.

use vibrissa_text::diagnostic::Position;

use crate::geometry::OffsetError;

/// The reason why a solid has no convex parts for MuJoCo. Simulators of the exact outline can simulate it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{} ({}); {}", self.message(), self.label(), self.advice())]
pub enum PartsFault {
    /// The outline has too many corners.
    Corners {
        /// The number of corners, with chords for arcs.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// Chords of arcs intersect, because the arcs are too close to each other.
    Chords,
    /// A wall has too many parts.
    Wall {
        /// The number of parts.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// A rough solid has too many parts.
    Waves {
        /// The number of parts.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// The core of a rough solid cannot be determined.
    Core(#[from] OffsetError),
    /// All solids together have too many parts.
    Parts {
        /// The number of parts up to this solid.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// All solids together have too large parts.
    SquaredCorners {
        /// The sum of the squared numbers of corners of all parts up to this solid.
        sum: usize,
        /// The largest permitted sum.
        limit: usize,
    },
}

impl PartsFault {
    /// True if the solids together are too large, not this one.
    pub(crate) fn is_of_all(&self) -> bool {
        matches!(self, Self::Parts { .. } | Self::SquaredCorners { .. })
    }

    /// What is wrong.
    pub(crate) fn message(&self) -> &'static str {
        match self {
            Self::Corners { .. } => "the object has too many corners for MuJoCo",
            Self::Chords => "the object comes within micrometres of itself, which is too close for MuJoCo",
            Self::Wall { .. } => "the tunnel is too long for MuJoCo",
            Self::Waves { .. } => "the rough surface has too many waves for MuJoCo",
            Self::Core(_) => "the object cannot have this texture in MuJoCo",
            Self::Parts { .. } | Self::SquaredCorners { .. } => "the objects together are too large for MuJoCo",
        }
    }

    /// How much it is.
    pub(crate) fn label(&self) -> String {
        match self {
            Self::Corners { count, limit } => format!("{count} corners; the limit is {limit}"),
            Self::Chords => "two of its sides are too close to each other".to_owned(),
            Self::Wall { count, limit } | Self::Waves { count, limit } => {
                format!("{count} parts; the limit is {limit}")
            }
            Self::Core(error) => error.to_string(),
            Self::Parts { count, limit } => format!("{count} parts up to this object; the limit is {limit}"),
            Self::SquaredCorners { sum, limit } => format!(
                "{sum} as the sum of the squared corner counts of all parts up to this object; the limit is {limit}"
            ),
        }
    }

    /// What to do.
    pub(crate) fn advice(&self) -> &'static str {
        match self {
            Self::Corners { .. } => "leave out vertices at which the outline is almost straight, or use arcs",
            Self::Chords => "move its sides apart",
            Self::Wall { .. } => "make the tunnel shorter, or its bends wider",
            Self::Waves { .. } => "make the wavelength longer, or the object smaller",
            Self::Core(_) => "use a slightly different amplitude",
            Self::Parts { .. } | Self::SquaredCorners { .. } => {
                "leave out objects or make them smaller, because an arc becomes up to some hundred chords"
            }
        }
    }
}

/// Solids that MuJoCo cannot simulate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{fault}", in_line(*place))]
pub struct PartsError {
    /// The index of the first solid with a fault.
    pub solid: usize,
    /// The position of its object in the text of a scenario, if it has one.
    pub place: Option<Position>,
    /// The fault.
    pub fault: PartsFault,
}

fn in_line(place: Option<Position>) -> String {
    place.map_or_else(String::new, |place| format!("in line {} of the scenario, ", place.line))
}
