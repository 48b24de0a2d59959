//! The solids of a scene.

use std::sync::{Arc, OnceLock};

use vibrissa_text::diagnostic::Position;

use crate::geometry::{Contour, Side, Strip, StripError, Texture, TextureError};

use super::composition::Composition;
use super::part::Part;
use super::parts_fault::PartsFault;

/// A solid: its exact outline, its rough surface if it has a texture, and its convex parts for MuJoCo.
///
/// The parts are built when they are first asked for. Clones share them.
#[derive(Debug, Clone)]
pub struct Solid {
    outline: Contour,
    rough: Option<Contour>,
    composition: Composition,
    parts: Arc<OnceLock<Result<Vec<Part>, PartsFault>>>,
    place: Option<Position>,
}

/// The reason why a contour does not define a solid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// The contour is open and has no interior.
    #[error("an open contour has no interior; close it")]
    Open,
    /// A wall has no outline.
    #[error(transparent)]
    Strip(#[from] StripError),
    /// An outline cannot have a texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

impl Solid {
    /// Creates the solid inside of `outline` (world frame).
    ///
    /// A convex solid is one part. Circles and polygons are exact. Other outlines have chords for their arcs, within 1
    /// µm up to a radius of 0.2 m, and within 4.7e-6 of the radius beyond. A concave solid has several parts that share
    /// edges, with chords within 5 µm up to a radius of 1 m.
    ///
    /// # Errors
    /// [`SolidError`] if the contour is open.
    pub fn inside(outline: Contour) -> Result<Self, SolidError> {
        if !outline.is_closed() {
            return Err(SolidError::Open);
        }
        Ok(Self::new(outline, None, Composition::Smooth))
    }

    /// Creates the solid inside of `outline` (world frame) with a rough surface.
    ///
    /// Its parts in MuJoCo are a layer of small ones under the surface and a core. Their chords are within a tenth of
    /// the texture's amplitude of the rough surface.
    ///
    /// # Errors
    /// [`SolidError`] if the outline cannot have the texture.
    pub fn textured(outline: Contour, texture: &Texture) -> Result<Self, SolidError> {
        let rough = outline.textured(texture)?;
        Ok(Self::new(outline, Some(rough), Composition::Rough { amplitude: texture.amplitude }))
    }

    /// Creates a wall (world frame). `face` is its accessible side. The chords of its bends are within 10 µm of the
    /// face, and within 0.1 mm of the other side.
    ///
    /// The outline of a wall along a closed line is its face. The enclosed area is inaccessible and counts as solid.
    ///
    /// # Errors
    /// [`SolidError`] if the wall intersects itself.
    pub fn wall(wall: &Strip, face: Side) -> Result<Self, SolidError> {
        let side = wall.side(face);
        let outline = if side.is_closed() { side.clone() } else { wall.outline()? };
        Ok(Self::new(outline, None, Composition::Wall { strip: Arc::new(wall.clone()), face }))
    }

    fn new(outline: Contour, rough: Option<Contour>, composition: Composition) -> Self {
        Self { outline, rough, composition, parts: Arc::default(), place: None }
    }

    /// The same solid with the position of its object in the text of a scenario, for messages.
    #[must_use]
    pub fn at(self, place: Position) -> Self {
        Self { place: Some(place), ..self }
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

    /// The position of its object in the text of a scenario, if it has one.
    #[must_use]
    pub fn place(&self) -> Option<Position> {
        self.place
    }

    /// The convex parts for MuJoCo. They share edges; those of a wall overlap slightly.
    ///
    /// # Errors
    /// [`PartsFault`] if there are too many, or if the outline is too close to itself.
    pub fn parts(&self) -> Result<&[Part], &PartsFault> {
        let parts = self.parts.get_or_init(|| self.composition.parts(&self.outline, self.surface()));
        parts.as_ref().map(Vec::as_slice)
    }
}
