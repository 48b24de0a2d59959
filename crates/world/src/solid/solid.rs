//! The solids of a scene.

use crate::geometry::{Contour, OffsetError, Side, Strip, StripError, Texture, TextureError};

use super::part::Part;
use super::{decompose, rough, wall};

/// The largest number of parts of a solid. MuJoCo needs some 70 µs to build each.
const MAX_PARTS: usize = 4096;

/// A solid: its exact outline, its rough surface if it has a texture, and its convex parts for MuJoCo.
#[derive(Debug, Clone)]
pub struct Solid {
    outline: Contour,
    rough: Option<Contour>,
    parts: Vec<Part>,
}

/// The reason why a contour does not define a solid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// The contour is open and has no interior.
    #[error("an open contour has no interior; close it")]
    Open,
    /// The contour has too many pieces.
    #[error("a contour of {count} corners, arcs as chords, is too large to be simulated; use at most {limit}")]
    Corners {
        /// The number of corners of the prism.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// Chords of arcs intersect, because the arcs are too close to each other.
    #[error("the contour comes within micrometres of itself; move its sides apart")]
    Chords,
    /// A wall has too many parts.
    #[error("a wall of {count} parts is too large to be simulated; use at most {limit}: make it shorter")]
    Parts {
        /// The number of parts.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// A rough solid has too many parts.
    #[error(
        "a rough surface of {count} parts is too large to be simulated; use at most {limit}: make the waves longer"
    )]
    Waves {
        /// The number of parts.
        count: usize,
        /// The largest permitted number.
        limit: usize,
    },
    /// A wall has no outline.
    #[error(transparent)]
    Strip(#[from] StripError),
    /// An outline cannot have a texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The core of a rough solid cannot be determined.
    #[error(transparent)]
    Core(#[from] OffsetError),
}

impl Solid {
    /// Creates the solid inside of `outline` (world frame).
    ///
    /// A convex solid is one part. Circles and polygons are exact. Other outlines have chords for their arcs, within 1
    /// µm up to a radius of 0.2 m, and within 4.7e-6 of the radius beyond. A concave solid has several parts that share
    /// edges, with chords within 5 µm up to a radius of 1 m.
    ///
    /// # Errors
    /// [`SolidError`] if the contour is open, has too many pieces, or is too close to itself.
    pub fn inside(outline: Contour) -> Result<Self, SolidError> {
        if !outline.is_closed() {
            return Err(SolidError::Open);
        }
        let parts = smooth_parts(&outline)?;
        Ok(Self { outline, rough: None, parts })
    }

    /// Creates the solid inside of `outline` (world frame) with a rough surface.
    ///
    /// Its parts in MuJoCo are a layer of small ones under the surface and a core. Their chords are within a tenth of
    /// the texture's amplitude of the rough surface.
    ///
    /// # Errors
    /// [`SolidError`] as for [`inside`](Self::inside), if the outline cannot have the texture, or if there are too many
    /// waves.
    pub fn textured(outline: Contour, texture: &Texture) -> Result<Self, SolidError> {
        let rough = outline.textured(texture)?;
        let mut parts = rough::layer(&rough, texture.amplitude);
        if parts.is_empty() {
            parts = smooth_parts(&rough)?;
        } else {
            for core in outline.offset(-rough::DEPTH_OF_CORE * texture.amplitude)? {
                parts.extend(smooth_parts(&core)?);
            }
        }
        if parts.len() > MAX_PARTS {
            return Err(SolidError::Waves { count: parts.len(), limit: MAX_PARTS });
        }
        Ok(Self { outline, rough: Some(rough), parts })
    }

    /// Creates a wall (world frame). `face` is its accessible side. The chords of its bends are within 10 µm of the
    /// face, and within 0.1 mm of the other side.
    ///
    /// The outline of a wall along a closed line is its face. The enclosed area is inaccessible and counts as solid.
    ///
    /// # Errors
    /// [`SolidError`] if the wall intersects itself or is too long.
    pub fn wall(wall: &Strip, face: Side) -> Result<Self, SolidError> {
        let side = wall.side(face);
        let outline = if side.is_closed() { side.clone() } else { wall.outline()? };
        let parts = wall::parts(wall, face);
        if parts.len() > MAX_PARTS {
            return Err(SolidError::Parts { count: parts.len(), limit: MAX_PARTS });
        }
        Ok(Self { outline, rough: None, parts })
    }

    /// The exact outline (world frame), without texture. It is the reference of scores.
    #[must_use]
    pub fn outline(&self) -> &Contour {
        &self.outline
    }

    /// The surface that whiskers and platform touch (world frame): the outline with its texture.
    #[must_use]
    pub fn surface(&self) -> &Contour {
        self.rough.as_ref().unwrap_or(&self.outline)
    }

    /// The convex parts for MuJoCo. They share edges; those of a wall overlap slightly.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }
}

/// The convex parts of the interior of a closed contour.
fn smooth_parts(outline: &Contour) -> Result<Vec<Part>, SolidError> {
    if outline.is_convex() { Ok(vec![Part::inside(outline)?]) } else { decompose::parts(outline) }
}
