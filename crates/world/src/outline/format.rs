//! The formats of outline files.

use std::path::Path;

/// The format of an outline file.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Format {
    /// Scalable Vector Graphics.
    Svg,
    /// Drawing Exchange Format, as text.
    Dxf,
    /// A polygon: a line for each corner, with x and y.
    Csv,
    /// A triangle mesh, as text or binary, which is cut by a plane.
    Stl,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Svg, Self::Dxf, Self::Csv, Self::Stl];

    /// Returns the format for the extension of a file name.
    ///
    /// ```
    /// use vibrissa_world::outline::Format;
    /// assert_eq!(Format::of("parts/gripper.SVG"), Some(Format::Svg));
    /// assert_eq!(Format::of("gripper.png"), None);
    /// ```
    #[must_use]
    pub fn of(path: &str) -> Option<Self> {
        let ending = Path::new(path).extension()?.to_str()?;
        Self::ALL.into_iter().find(|format| format.ending().eq_ignore_ascii_case(ending))
    }

    /// The extension of such files, without the point.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Dxf => "dxf",
            Self::Csv => "csv",
            Self::Stl => "stl",
        }
    }
}
