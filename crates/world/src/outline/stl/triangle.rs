//! Triangles of a mesh.

/// A triangle.
pub(super) struct Triangle {
    /// The coordinates of its corners, in units of the file.
    pub(super) corners: [[f32; 3]; 3],
    /// Its line in a text.
    pub(super) line: Option<usize>,
}

/// A part of a mesh.
pub(super) type Solid = Vec<Triangle>;
