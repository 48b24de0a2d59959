//! The solids of a scene.

use crate::geometry::{Contour, Side, Strip, StripError};

use super::part::Part;
use super::{decompose, wall};

/// The most parts of a solid: MuJoCo takes some 70 µs to build each.
const MOST_PARTS: usize = 4096;

/// Something solid: its exact outline, and what stands for it in MuJoCo.
#[derive(Debug, Clone)]
pub struct Solid {
    outline: Contour,
    parts: Vec<Part>,
}

/// Why a contour has no solid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// The contour has ends, so that it has no inside.
    #[error("an open contour has no inside that could be solid; close it")]
    Open,
    /// The contour has too many pieces.
    #[error("a contour of {count} corners, arcs as chords, is too large to be simulated; use at most {limit}")]
    Corners {
        /// How many corners its prism would have.
        count: usize,
        /// The most that there may be.
        limit: usize,
    },
    /// Chords that stand for arcs meet each other, where the arcs come nearer to each other than that.
    #[error("the contour comes within micrometres of itself; move its sides apart")]
    Chords,
    /// A wall has too many parts.
    #[error("a wall of {count} parts is too large to be simulated; use at most {limit}: make it shorter")]
    Parts {
        /// How many parts it would have.
        count: usize,
        /// The most that there may be.
        limit: usize,
    },
    /// A wall has no outline.
    #[error(transparent)]
    Strip(#[from] StripError),
}

impl Solid {
    /// The solid inside of `outline` (world frame).
    ///
    /// A convex one is one part: a circle and a polygon exactly, any other with chords for its arcs, which lie within 1 µm of
    /// them up to a radius of 0.2 m, and within 4.7 millionths of the radius beyond. A concave one is several parts that share
    /// edges, with chords within 5 µm up to a radius of 1 m.
    ///
    /// # Errors
    /// [`SolidError`] when the contour is open, of too many pieces, or comes too near to itself.
    pub fn inside(outline: Contour) -> Result<Self, SolidError> {
        if !outline.is_closed() {
            return Err(SolidError::Open);
        }
        let parts = if outline.is_convex() { vec![Part::inside(&outline)?] } else { decompose::parts(&outline)? };
        Ok(Self { outline, parts })
    }

    /// A wall (world frame), whose `face` is the side that is to be touched: chords for its bends lie within 10 µm of it, and
    /// within 0.1 mm of the other side.
    ///
    /// A wall along a closed line has its face for its outline: what it encloses cannot be reached, and counts as solid.
    ///
    /// # Errors
    /// [`SolidError`] when the wall meets itself, or is too long.
    pub fn wall(wall: &Strip, face: Side) -> Result<Self, SolidError> {
        let side = wall.side(face);
        let outline = if side.is_closed() { side.clone() } else { wall.outline()? };
        let parts = wall::parts(wall, face);
        if parts.len() > MOST_PARTS {
            return Err(SolidError::Parts { count: parts.len(), limit: MOST_PARTS });
        }
        Ok(Self { outline, parts })
    }

    /// The exact outline (world frame).
    #[must_use]
    pub fn outline(&self) -> &Contour {
        &self.outline
    }

    /// What stands for it in MuJoCo: convex parts that share edges. Those of a wall overlap a little.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }
}
