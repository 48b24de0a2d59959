//! What is wanted of a file.

/// What is wanted of a file, and what it may not say by itself.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ReadOptions<'r> {
    /// What 1 in the file is (m); `None` if the file says it.
    pub unit: Option<f64>,
    /// The `id` of an element of an SVG, or the name of a layer of a DXF: what is in it alone. `None` for all that is in the
    /// file.
    pub element: Option<&'r str>,
    /// How far (m) above the z = 0 of an STL the plane lies that cuts it.
    pub height: f64,
}
