//! Outlines from files: SVG, DXF and CSV drawings, and STL meshes cut by a plane.
//!
//! Circles and arcs become exact arcs of a [`Contour`]. Other curves are approximated by arcs within a micrometre.
//! Files are untrusted input: every content gives contours or an [`OutlineError`].
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
#[cfg(feature = "outlines")]
mod stl;
#[cfg(feature = "outlines")]
mod svg;
#[cfg(feature = "outlines")]
mod text;
#[cfg(feature = "outlines")]
mod transform;

pub use error::{OutlineError, OutlineFault};
pub use format::Format;

use crate::geometry::Contour;

/// The largest size of a file (bytes).
pub const SIZE_LIMIT: usize = 16 << 20;

/// The largest distance (m) of two ends that are joined, and of an approximation from its curve.
#[cfg(feature = "outlines")]
const TOLERANCE: f64 = 1e-6;

/// The largest number of pieces of all outlines of a file, and of all objects of a scenario.
pub(crate) const MAX_PIECES: usize = 200_000;

/// The largest number of outlines of a file.
#[cfg(feature = "outlines")]
const MAX_OUTLINES: usize = 256;

/// The options of a reader. They include properties that a file may lack.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ReadOptions<'r> {
    /// The length of a file unit (m). `None` if the file states it.
    pub unit: Option<f64>,
    /// The `id` of an SVG element or the name of a DXF layer, if only its content is read. `None` for the whole file.
    pub element: Option<&'r str>,
    /// The height (m) of the cutting plane above the z = 0 of an STL.
    pub height: f64,
    /// What is done with an outline within another.
    pub holes: Holes,
}

vibrissa_runtime::kinds! {
    /// What is done with an outline within another. Whiskers cannot reach it.
    #[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
    pub enum Holes,
    /// The name in scenarios.
    fn name {
        /// It is an error, because it could also be an object.
        #[default]
        Refuse = "refuse",
        /// It is left out.
        Ignore = "ignore",
    }
}

/// Reads the outlines of a file: closed contours, none within another. They may touch. Their frame is the file's, in
/// metres, with the y axis up. The y axis of an SVG points down, so its content is mirrored.
///
/// # Errors
/// [`OutlineError`], with the line if it is known.
#[cfg(feature = "outlines")]
pub fn read(bytes: &[u8], format: Format, options: &ReadOptions<'_>) -> Result<Vec<Contour>, OutlineError> {
    if bytes.len() > SIZE_LIMIT {
        return Err(OutlineFault::TooLarge { what: "bytes", limit: SIZE_LIMIT }.into());
    }
    if bytes.is_empty() {
        return Err(OutlineFault::Empty.into());
    }
    let mut outlines = match format {
        Format::Svg => svg::read(bytes, options),
        Format::Dxf => dxf::read(bytes, options),
        Format::Csv => csv::read(bytes, options),
        Format::Stl => stl::read(bytes, options),
    }?;
    match options.holes {
        Holes::Refuse => outline_list::check_nesting(&outlines)?,
        Holes::Ignore => outline_list::leave_out_nested(&mut outlines),
    }
    Ok(outlines.into_iter().map(|outline| outline.contour).collect())
}

/// Reads the outlines of a file.
///
/// # Errors
/// Always, because the readers require the feature `outlines`.
#[cfg(not(feature = "outlines"))]
pub fn read(_: &[u8], _: Format, _: &ReadOptions<'_>) -> Result<Vec<Contour>, OutlineError> {
    Err(OutlineFault::NotBuilt.into())
}
