//! What holds for every contour, tried on thousands of random ones.

mod distance;
mod measure;
mod motion;
mod offset;
mod oracle;
pub(crate) mod random;
mod set;
mod simple;
mod texture;
mod union;
