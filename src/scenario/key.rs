//! A key whose value is a number.

use vibrissa_runtime::units::{Dimension, format_si};

/// A key whose value is a number: its name, what it measures, and the range in which a value makes sense.
///
/// The ranges are wide. They refuse what is impossible (a negative radius) and what can only be a slip (a whisker of 100 m).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) dimension: Dimension,
    /// The least and the greatest value, in SI units.
    pub(crate) range: (f64, f64),
    /// A value to show to somebody who needs one.
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

    /// The range in words.
    pub(crate) fn range_text(&self) -> String {
        let (least, greatest) = self.range;
        let text = |value| match self.example.strip_suffix('%') {
            Some(_) => format!("{} %", format_si(100.0 * value, self.dimension)),
            None => format_si(value, self.dimension),
        };
        format!("from {} to {}", text(least), text(greatest))
    }
}
