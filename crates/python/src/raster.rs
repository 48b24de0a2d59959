//! Pictures as pixels.

use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::error::error;

/// The pixels of a picture.
pub(crate) struct Pixels {
    height: usize,
    width: usize,
    /// Red, green and blue of every pixel, row by row.
    values: Vec<u8>,
}

impl Pixels {
    /// Draws an opaque SVG without its texts.
    ///
    /// # Errors
    /// The text is not an SVG.
    pub(crate) fn draw(svg: &str) -> PyResult<Self> {
        let tree = Tree::from_str(svg, &Options::default()).map_err(error)?;
        let size = tree.size().to_int_size();
        let mut drawn = Pixmap::new(size.width(), size.height()).ok_or_else(|| error("the picture has no pixels"))?;
        resvg::render(&tree, Transform::identity(), &mut drawn.as_mut());
        let (height, width) = (size.height() as usize, size.width() as usize);
        // An opaque pixel has its colours as they are.
        let values = drawn.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
        Ok(Self { height, width, values })
    }

    /// An array of height x width x 3 numbers.
    pub(crate) fn array(self, py: Python<'_>) -> PyResult<Bound<'_, PyArray3<u8>>> {
        PyArray1::from_vec(py, self.values).reshape([self.height, self.width, 3])
    }
}
