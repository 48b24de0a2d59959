//! A range of values.

use vibrissa_runtime::math;

/// A range of values (SI units) from which a true value is drawn. A single value is a range
/// without width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The smallest value.
    pub least: f64,
    /// The largest value.
    pub greatest: f64,
}

impl Range {
    /// The value at a share of the range, 0 to 1.
    #[must_use]
    pub fn at(self, share: f64) -> f64 {
        self.least + share * (self.greatest - self.least)
    }

    /// The value at a share of the range of logarithms, 0 to 1, for a range above 0.
    #[must_use]
    pub fn at_logarithm(self, share: f64) -> f64 {
        self.least * math::powf(self.greatest / self.least, share)
    }
}

impl From<f64> for Range {
    fn from(value: f64) -> Self {
        Self { least: value, greatest: value }
    }
}
