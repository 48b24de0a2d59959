//! OutlineList from files: SVG, DXF and CSV drawings, and STL meshes cut by a plane.
//!
//! What is round in a file stays round: circles and arcs are arcs of a [`Contour`], other curves are fitted by arcs to a
//! micrometre. Files come from outside: whatever is in them, they give contours or an [`OutlineError`].
//!
//! Only builds with the feature `outlines` can read them.

#[cfg(feature = "outlines")]
mod assemble;
#[cfg(feature = "outlines")]
mod chain;
#[cfg(feature = "outlines")]
mod csv;
#[cfg(feature = "outlines")]
mod dxf;
mod error;
mod format;
#[cfg(feature = "outlines")]
mod outline_list;
mod read_options;
#[cfg(feature = "outlines")]
mod stl;
#[cfg(feature = "outlines")]
mod svg;
#[cfg(feature = "outlines")]
mod transform;

pub use error::{OutlineError, OutlineFault};
pub use format::Format;
pub use read_options::ReadOptions;

use crate::geometry::Contour;

/// The most bytes that a file may have.
pub const SIZE_LIMIT: usize = 16 << 20;

/// How far apart (m) two ends may be that are meant to be one; and how far a curve may be from what it becomes.
#[cfg(feature = "outlines")]
const TOLERANCE: f64 = 1e-6;

/// The most pieces that all outlines of a file may have together, and all objects of a scenario.
pub const MOST_PIECES: usize = 10_000;

/// The most outlines of a file.
#[cfg(feature = "outlines")]
const MOST_OUTLINES: usize = 256;

/// The outlines in a file: closed contours, none within another. They may meet. Their frame is the file's, in metres; its y
/// axis points up, so that an SVG, whose own points down, is mirrored.
///
/// # Errors
/// [`OutlineError`], with the line where that is known.
#[cfg(feature = "outlines")]
pub fn read(bytes: &[u8], format: Format, options: &ReadOptions<'_>) -> Result<Vec<Contour>, OutlineError> {
    if bytes.len() > SIZE_LIMIT {
        return Err(OutlineFault::TooLarge { what: "bytes", limit: SIZE_LIMIT }.into());
    }
    if bytes.is_empty() {
        return Err(OutlineFault::Empty.into());
    }
    let outlines = match format {
        Format::Svg => svg::read(bytes, options),
        Format::Dxf => dxf::read(bytes, options),
        Format::Csv => csv::read(bytes, options),
        Format::Stl => stl::read(bytes, options),
    }?;
    outline_list::check_nesting(&outlines)?;
    Ok(outlines.into_iter().map(|outline| outline.contour).collect())
}

/// The outlines in a file.
///
/// # Errors
/// Always: reading them needs the feature `outlines`.
#[cfg(not(feature = "outlines"))]
pub fn read(_: &[u8], _: Format, _: &ReadOptions<'_>) -> Result<Vec<Contour>, OutlineError> {
    Err(OutlineFault::NotBuilt.into())
}
