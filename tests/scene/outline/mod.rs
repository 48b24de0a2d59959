//! Outlines from files: what is drawn is what becomes of it, and whatever is in a file is answered.

mod bad;
mod cases;
mod csv;
mod dxf;
mod hostile;
mod same;
mod scenario;
mod stl;
mod svg;

use std::path::{Path, PathBuf};

use vibrissa::geometry::Contour;
use vibrissa::outline::{Format, OutlineError, ReadOptions, read};

/// Where the files lie.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/outlines")
}

/// The outlines of a file, in which 1 is a millimetre.
fn outlines(file: &str) -> Result<Vec<Contour>, OutlineError> {
    let bytes = std::fs::read(folder().join(file)).unwrap();
    let options = ReadOptions { unit: Some(1e-3), element: None, height: 0.01, ..ReadOptions::default() };
    read(&bytes, Format::of(file).unwrap(), &options)
}

/// How far (m) two contours are apart at most, looked at in many places.
fn apart(first: &Contour, second: &Contour) -> f64 {
    let off = |from: &Contour, to: &Contour| {
        let places = (0..4000).map(|k| from.point_at(from.length() * f64::from(k) / 4000.0));
        places.map(|place| to.nearest(place).distance).fold(0.0, f64::max)
    };
    off(first, second).max(off(second, first))
}
