//! Keys with a numeric value.

use vibrissa_runtime::units::{Dimension, format_si};

/// A key with a numeric value: its name, dimension and range.
///
/// The ranges are wide. They exclude impossible values, such as a negative radius, and obvious mistakes, such as a
/// whisker of 100 m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) dimension: Dimension,
    /// The smallest and the largest value, in SI units.
    pub(crate) range: (f64, f64),
    /// An example for messages.
    pub(crate) example: &'static str,
}

impl Key {
    pub(crate) const fn new(
        name: &'static str,
        dimension: Dimension,
        range: (f64, f64),
        example: &'static str,
    ) -> Self {
        Self { name, dimension, range, example }
    }

    /// The range as text.
    pub(crate) fn range_text(&self) -> String {
        let (least, greatest) = self.range;
        let text = |value| match self.example.strip_suffix('%') {
            Some(_) => format!("{} %", format_si(100.0 * value, self.dimension)),
            None => format_si(value, self.dimension),
        };
        format!("from {} to {}", text(least), text(greatest))
    }
}
