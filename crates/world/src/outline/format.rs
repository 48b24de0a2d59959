//! The formats of outline files.

use std::path::Path;

vibrissa_runtime::kinds! {
    /// The format of an outline file.
    #[derive(Copy, Clone, Debug, PartialEq, Eq)]
    pub enum Format,
    /// The extension of such files, without the point.
    fn ending {
        /// Scalable Vector Graphics.
        Svg = "svg",
        /// Drawing Exchange Format, as text.
        Dxf = "dxf",
        /// A polygon: a line for each corner, with x and y.
        Csv = "csv",
        /// A triangle mesh, as text or binary, which is cut by a plane.
        Stl = "stl",
    }
}

impl Format {
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
}
