//! Errors of shapes.

use crate::geometry::{ContourError, MIN_PIECE_LENGTH, StripError};

/// The reason why a shape cannot be created.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// A number is infinite or not a number.
    #[error("the {what} is {value}: it must be a finite number")]
    NotFinite {
        /// The name of the number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A length is zero or negative.
    #[error("the {what} is {value} m: it must be positive")]
    NotPositive {
        /// The name of the length.
        what: &'static str,
        /// Its value (m).
        value: f64,
    },
    /// A polygon has too few sides.
    #[error("a polygon needs at least 3 sides, not {sides}")]
    TooFewSides {
        /// The number of its sides.
        sides: usize,
    },
    /// Two consecutive points of a polygon coincide.
    #[error(
        "points {from} and {to} of the polygon are the same: leave one out (the first point is not repeated at the end)"
    )]
    ZeroEdge {
        /// The first of these points, counted from 0.
        from: usize,
        /// The second.
        to: usize,
    },
    /// The corner radius is too large for the sides.
    #[error("the corner radius is {radius} m: it must be between 0 and half the shorter side, {limit} m")]
    CornerRadius {
        /// The radius (m).
        radius: f64,
        /// The largest possible radius (m).
        limit: f64,
    },
    /// A path ends near its start, but not at it.
    #[error(
        "the path ends {gap} m from its start. This is too far to close it, and too short for a side: give lengths and \
         angles with more digits, or leave out the last length"
    )]
    NearlyClosed {
        /// The distance from its end to its start (m).
        gap: f64,
    },
    /// A step of a path has no length.
    #[error("step {step} of the path is {length} m long: leave it out, or make it longer than {MIN_PIECE_LENGTH} m")]
    ShortStep {
        /// The straight or arc, counted from 0 among all straights and arcs.
        step: usize,
        /// Its length (m).
        length: f64,
    },
    /// The waves of a curve are too small for an approximation by arcs.
    #[error("the harmonics of the curve are too fine: use lower orders")]
    TooFine,
    /// A tunnel bends too tightly for its width.
    #[error("the tunnel bends too tightly for its width: make it narrower, or its bends wider")]
    TooTight,
    /// The opening of a round tunnel and its funnel are longer than the wall.
    #[error(
        "the opening and its funnel do not fit into the wall: `from` must be below `to`, and the wall must be long enough for the funnel on each side"
    )]
    Opening,
    /// A wall is too thick.
    #[error(transparent)]
    Strip(#[from] StripError),
    /// The pieces are not a contour.
    #[error(transparent)]
    Contour(#[from] ContourError),
}

/// Rejects a number that is not finite.
pub(super) fn finite(what: &'static str, value: f64) -> Result<(), ShapeError> {
    if value.is_finite() { Ok(()) } else { Err(ShapeError::NotFinite { what, value }) }
}

/// Rejects a length that is not finite and positive.
pub(super) fn positive(what: &'static str, value: f64) -> Result<(), ShapeError> {
    finite(what, value)?;
    if value > 0.0 { Ok(()) } else { Err(ShapeError::NotPositive { what, value }) }
}

/// Rejects a point whose coordinates are not finite.
pub(super) fn finite_point(what: &'static str, point: crate::geometry::Point2) -> Result<(), ShapeError> {
    finite(what, point.x)?;
    finite(what, point.y)
}
