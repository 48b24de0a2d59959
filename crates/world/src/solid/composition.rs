//! How a solid is composed of convex parts.

use std::sync::Arc;

use crate::geometry::{Contour, Side, Strip};

use super::part::Part;
use super::parts_fault::PartsFault;
use super::{decompose, rough, wall};

/// The largest number of parts of a solid. MuJoCo needs some 70 µs to build each.
const MAX_PARTS: usize = 4096;

/// How a solid is composed of convex parts.
#[derive(Debug, Clone)]
pub(super) enum Composition {
    /// One part, or several that share edges.
    Smooth,
    /// A layer of parts under a surface with a texture of this `amplitude` (m), and a core.
    Rough { amplitude: f64 },
    /// The pieces of a wall with an accessible `face`.
    Wall { strip: Arc<Strip>, face: Side },
}

impl Composition {
    /// The convex parts of a solid with this outline and surface.
    pub(super) fn parts(&self, outline: &Contour, surface: &Contour) -> Result<Vec<Part>, PartsFault> {
        match self {
            Self::Smooth => smooth_parts(outline),
            Self::Rough { amplitude } => rough_parts(outline, surface, *amplitude),
            Self::Wall { strip, face } => {
                let parts = wall::parts(strip, *face);
                if parts.len() > MAX_PARTS {
                    return Err(PartsFault::Wall { count: parts.len(), limit: MAX_PARTS });
                }
                Ok(parts)
            }
        }
    }
}

/// The convex parts of the interior of a closed contour.
fn smooth_parts(outline: &Contour) -> Result<Vec<Part>, PartsFault> {
    if outline.is_convex() { Ok(vec![Part::inside(outline)?]) } else { decompose::parts(outline) }
}

/// The convex parts of the interior of a rough surface about an `outline`.
fn rough_parts(outline: &Contour, surface: &Contour, amplitude: f64) -> Result<Vec<Part>, PartsFault> {
    let mut parts = rough::layer(surface, amplitude);
    if parts.is_empty() {
        parts = smooth_parts(surface)?;
    } else {
        for core in outline.offset(-rough::DEPTH_OF_CORE * amplitude)? {
            parts.extend(smooth_parts(&core)?);
        }
    }
    if parts.len() > MAX_PARTS {
        return Err(PartsFault::Waves { count: parts.len(), limit: MAX_PARTS });
    }
    Ok(parts)
}
