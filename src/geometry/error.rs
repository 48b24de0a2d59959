//! Why pieces do not make a contour.

use super::{JOIN_TOLERANCE, Point2, SHORTEST_PIECE};

/// Why pieces do not make a contour. Pieces are counted from 0, as they were given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContourError {
    /// There is no piece.
    #[error("a contour needs at least one piece")]
    Empty,
    /// A coordinate, a radius or an angle is infinite or not a number.
    #[error("piece {piece} has a number that is not finite")]
    NotFinite {
        /// The piece.
        piece: usize,
    },
    /// A radius is zero or negative.
    #[error(
        "the radius of arc {piece} is {radius} m: it must be positive (the sign of the sweep says which way it bends)"
    )]
    Radius {
        /// The piece.
        piece: usize,
        /// Its radius (m).
        radius: f64,
    },
    /// An arc goes round more than once.
    #[error("arc {piece} sweeps {sweep} rad: it can sweep at most a full circle, 2π")]
    Sweep {
        /// The piece.
        piece: usize,
        /// Its sweep (rad).
        sweep: f64,
    },
    /// A piece has no length to speak of.
    #[error("piece {piece} is {length} m long: leave it out, or make it longer than {SHORTEST_PIECE} m")]
    TooShort {
        /// The piece.
        piece: usize,
        /// Its length (m).
        length: f64,
    },
    /// A piece does not start where the one before it ends.
    #[error(
        "piece {piece} ends {distance} m from where piece {next} starts: move them together, to within {JOIN_TOLERANCE} m"
    )]
    Gap {
        /// The piece before the gap.
        piece: usize,
        /// The piece after it; the first one if a closed contour does not close.
        next: usize,
        /// The width of the gap (m).
        distance: f64,
    },
    /// An open contour ends where it starts.
    #[error("the contour ends where it starts: make it a closed one")]
    EndsMeet,
    /// There are too many long pieces beside each other to check that none meets another.
    #[error("more than {limit} pairs of its pieces may meet: use fewer long slanting sides")]
    Intricate {
        /// How many pairs can be checked.
        limit: usize,
    },
    /// Two pieces cross, touch or cover each other.
    #[error("pieces {first} and {second} meet at ({:.6}, {:.6}) m: a contour may not cross or touch itself", at.x, at.y)]
    SelfIntersection {
        /// The earlier piece.
        first: usize,
        /// The later piece.
        second: usize,
        /// A point that they share (m).
        at: Point2,
    },
}
