//! The options of a reader.

/// The options of a reader. They include properties that a file may lack.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ReadOptions<'r> {
    /// The length of a file unit (m). `None` if the file states it.
    pub unit: Option<f64>,
    /// The `id` of an SVG element or the name of a DXF layer, if only its content is read. `None` for the whole file.
    pub element: Option<&'r str>,
    /// The height (m) of the cutting plane above the z = 0 of an STL.
    pub height: f64,
}
