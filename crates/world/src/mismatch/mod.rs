//! The mismatch between the true array, which is simulated, and the array that control assumes.
//!
//! A [`Mismatch`] has a range for every property that differs. [`Mismatch::array`] draws the true array from the
//! ranges. The rig of a scene is the assumed one.

mod array;
mod loss;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod mismatch;
mod range;
mod ranges;
mod whisker;

pub use array::{PoseErrors, SensorErrors, TrueArray};
pub use loss::Loss;
pub use mismatch::{Mismatch, MismatchError};
pub use range::Range;
pub use ranges::Ranges;
pub use vibrissa_declare::mismatch::{Difference, Property};

#[cfg(test)]
mod tests;
