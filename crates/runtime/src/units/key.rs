//! Keys with a numeric value.

use super::{Dimension, format_si};

/// A key with a numeric value: its name, dimension and range.
///
/// The ranges are wide. They exclude impossible values, such as a negative radius, and obvious mistakes, such as a
/// whisker of 100 m.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// The name.
    pub name: &'static str,
    /// The dimension.
    pub dimension: Dimension,
    /// The smallest and the largest value, in SI units.
    pub range: (f64, f64),
    /// An example for messages.
    pub example: &'static str,
}

impl Key {
    /// Creates a key.
    #[must_use]
    pub const fn new(name: &'static str, dimension: Dimension, range: (f64, f64), example: &'static str) -> Self {
        Self { name, dimension, range, example }
    }

    /// True if a value (SI) is in the range. A value that is not a number is not.
    #[must_use]
    pub fn contains(&self, value_si: f64) -> bool {
        let (least, greatest) = self.range;
        (least..=greatest).contains(&value_si)
    }

    /// The range as text.
    #[must_use]
    pub fn range_text(&self) -> String {
        let (least, greatest) = self.range;
        let text = |value| match self.example.strip_suffix('%') {
            Some(_) => format!("{} %", format_si(100.0 * value, self.dimension)),
            None => format_si(value, self.dimension),
        };
        format!("from {} to {}", text(least), text(greatest))
    }
}
