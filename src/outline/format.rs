//! The formats of files with outlines.

use std::path::Path;

/// What a file with outlines is written in.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Format {
    /// Scalable Vector Graphics.
    Svg,
    /// Drawing Exchange Format, as text.
    Dxf,
    /// A polygon: a line for each corner, with x and y.
    Csv,
    /// A mesh of triangles, as text or binary, to be cut by a plane.
    Stl,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Svg, Self::Dxf, Self::Csv, Self::Stl];

    /// The format that the name of a file ends in.
    ///
    /// ```
    /// use vibrissa::outline::Format;
    /// assert_eq!(Format::of("parts/gripper.SVG"), Some(Format::Svg));
    /// assert_eq!(Format::of("gripper.png"), None);
    /// ```
    #[must_use]
    pub fn of(path: &str) -> Option<Self> {
        let ending = Path::new(path).extension()?.to_str()?;
        Self::ALL.into_iter().find(|format| format.ending().eq_ignore_ascii_case(ending))
    }

    /// What names of such files end in, after the point.
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
