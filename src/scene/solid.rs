//! The solids that a contour becomes in MuJoCo.

use crate::geometry::{Contour, Piece, Point2};

/// The furthest (m) that a prism's chord may lie from the arc that it stands for.
const SAGITTA: f64 = 1e-6;

/// A solid that MuJoCo can hold exactly, or within [`SAGITTA`].
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Solid {
    /// An upright cylinder.
    Cylinder {
        /// Its axis (m, world frame).
        centre: Point2,
        /// Its radius (m).
        radius: f64,
    },
    /// An upright convex prism.
    Prism {
        /// Its corners, counter-clockwise (m, world frame).
        outline: Vec<Point2>,
    },
}

/// Why a contour has no solid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SolidError {
    /// The contour has ends, so that it has no inside.
    #[error("an open contour has no inside that could be solid; close it")]
    Open,
    /// The contour is concave somewhere.
    #[error("a concave contour cannot be simulated as one solid yet; use a convex outline")]
    Concave,
}

impl Solid {
    /// The solid inside of `contour`.
    ///
    /// # Errors
    /// [`SolidError`] when the contour is open or concave.
    pub(super) fn from_contour(contour: &Contour) -> Result<Self, SolidError> {
        if !contour.is_closed() {
            return Err(SolidError::Open);
        }
        if let [Piece::Arc(arc)] = contour.pieces() {
            return Ok(Self::Cylinder { centre: arc.centre, radius: arc.radius });
        }
        if !contour.is_convex() {
            return Err(SolidError::Concave);
        }
        Ok(Self::Prism { outline: contour.pieces().iter().flat_map(chords).collect() })
    }
}

/// The starts of the chords that stand for a piece.
fn chords(piece: &Piece) -> impl Iterator<Item = Point2> {
    let count = match piece {
        Piece::Segment(_) => 1,
        Piece::Arc(arc) => {
            let widest = 2.0 * (1.0 - SAGITTA / arc.radius).clamp(-1.0, 1.0).acos();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive count")]
            let count = (arc.sweep.abs() / widest).ceil().max(1.0) as usize;
            count
        }
    };
    let length = piece.length();
    (0..count).map(move |chord| piece.point_at(length * chord as f64 / count as f64))
}
