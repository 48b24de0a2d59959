//! Errors of contours.

use super::{JOIN_TOLERANCE, MIN_PIECE_LENGTH, Point2};

/// The reason why pieces are not a contour. Pieces are counted from 0, in the given order.
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
        "the radius of arc {piece} is {radius} m: it must be positive (the sign of the sweep is the direction of the arc)"
    )]
    Radius {
        /// The piece.
        piece: usize,
        /// Its radius (m).
        radius: f64,
    },
    /// The sweep of an arc exceeds a full turn.
    #[error("arc {piece} sweeps {sweep} rad: it can sweep at most a full circle, 2π")]
    Sweep {
        /// The piece.
        piece: usize,
        /// Its sweep (rad).
        sweep: f64,
    },
    /// A piece is too short.
    #[error("piece {piece} is {length} m long: leave it out, or make it longer than {MIN_PIECE_LENGTH} m")]
    TooShort {
        /// The piece.
        piece: usize,
        /// Its length (m).
        length: f64,
    },
    /// A piece does not start at the end of the previous one.
    #[error(
        "piece {piece} ends {distance} m from where piece {next} starts: move them together, to within {JOIN_TOLERANCE} m"
    )]
    Gap {
        /// The piece before the gap.
        piece: usize,
        /// The piece after the gap, the first one if a closed contour does not close.
        next: usize,
        /// The width of the gap (m).
        distance: f64,
    },
    /// An open contour ends at its start.
    #[error("the contour ends at its start: make it closed")]
    EndsMeet,
    /// There are too many pairs of long neighbouring pieces for an intersection test.
    #[error("more than {limit} pairs of its pieces may intersect: use fewer long sides")]
    Intricate {
        /// The largest number of pairs.
        limit: usize,
    },
    /// Two pieces cross, touch or cover each other.
    #[error("pieces {first} and {second} meet at ({:.6}, {:.6}) m: a contour may not cross or touch itself", at.x, at.y)]
    SelfIntersection {
        /// The earlier piece.
        first: usize,
        /// The later piece.
        second: usize,
        /// A common point (m).
        at: Point2,
    },
}
