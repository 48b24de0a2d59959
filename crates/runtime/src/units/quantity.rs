//! Quantities: numbers with units.

use super::unit::{Unit, UnitError, parse_unit};
use super::{Dimension, format_si};
use std::fmt;
use std::ops::Range;
use thiserror::Error;

/// A number with its unit and its value in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Value in SI units and radians. It is always finite.
    pub value_si: f64,
    /// Dimension of the value.
    pub dimension: Dimension,
    /// Unit in the text, or `None` for a plain number.
    pub unit: Option<Unit>,
}

impl fmt::Display for Quantity {
    /// Writes the quantity in a convenient unit, as [`format_si`] does.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format_si(self.value_si, self.dimension))
    }
}

/// An error of parsing a quantity. Ranges are byte ranges of that text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum QuantityError {
    /// The text does not begin with a number.
    #[error("a quantity begins with a number")]
    Number {
        /// The part that is not a number.
        range: Range<usize>,
    },
    /// The number or its value in SI units is too large.
    #[error("the number is too large")]
    TooLarge {
        /// The number.
        range: Range<usize>,
    },
    /// The unit is invalid.
    #[error(transparent)]
    Unit(#[from] UnitError),
}

impl QuantityError {
    /// The byte range of the error.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        match self {
            Self::Number { range } | Self::TooLarge { range } => range.clone(),
            Self::Unit(error) => error.range(),
        }
    }

    /// A hint: the text to write instead.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Number { .. } => "write a number and its unit, such as 50 mm".to_owned(),
            Self::TooLarge { .. } => "write a finite number, such as 50 mm".to_owned(),
            Self::Unit(error) => error.hint(),
        }
    }
}

/// Parses a quantity: a decimal number and, except for plain numbers, a [unit](parse_unit). The space between the two
/// is optional.
///
/// # Errors
/// [`QuantityError`] with the position of the error.
///
/// ```
/// use vibrissa_runtime::units::{Dimension, parse_quantity};
/// let width = parse_quantity("50 mm").unwrap();
/// assert_eq!((width.value_si, width.dimension), (0.05, Dimension::LENGTH));
/// ```
pub fn parse_quantity(text: &str) -> Result<Quantity, QuantityError> {
    let start = text.len() - text.trim_start().len();
    let end = start + number_length(&text[start..]);
    let behind = text[end..].trim_start();
    let unit_start = text.len() - behind.len();
    let Ok(value) = text[start..end].parse::<f64>() else {
        return Err(QuantityError::Number { range: start..text.trim_end().len().max(start) });
    };
    let unit = if behind.is_empty() {
        None
    } else {
        Some(parse_unit(behind.trim_end()).map_err(|error| error.shifted(unit_start))?)
    };
    let value_si = unit.map_or(value, |unit| unit.to_si(value));
    if !value_si.is_finite() {
        return Err(QuantityError::TooLarge { range: start..end });
    }
    Ok(Quantity { value_si, dimension: unit.map_or(Dimension::NUMBER, Unit::dimension), unit })
}

/// Number of bytes of the decimal number at the start of the text. An `e` belongs to it only if digits follow.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let sign = |from: usize| usize::from(text[from..].starts_with(['+', '-']));
    let mut end = sign(0);
    end += digits(end);
    if text[end..].starts_with('.') {
        end += 1 + digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let exponent = end + 1 + sign(end + 1);
        match digits(exponent) {
            0 => {}
            count => end = exponent + count,
        }
    }
    end
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        parse_quantity(text).unwrap().value_si
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "the conversion is to be exact")]
    fn a_value_is_the_nearest_to_the_decimal_that_was_written() {
        assert_eq!(value("72 mm"), 0.072);
        assert_eq!(value("-20 urad"), -2e-5);
        assert_eq!(value("100 GPa"), 1e11);
        assert_eq!(value("95%"), 0.95);
        assert_eq!(value("1.5e-1 kHz"), 150.0);
        assert_eq!(value("105 deg"), 105_f64.to_radians());
        assert_eq!(value("7"), 7.0);
    }

    #[test]
    fn a_text_without_a_number_is_refused_with_its_position() {
        assert_eq!(parse_quantity(" wide "), Err(QuantityError::Number { range: 1..5 }));
        assert_eq!(parse_quantity("nan mm"), Err(QuantityError::Number { range: 0..6 }));
        assert_eq!(parse_quantity(""), Err(QuantityError::Number { range: 0..0 }));
    }

    #[test]
    fn an_infinite_number_is_refused() {
        assert_eq!(parse_quantity("1e999 mm"), Err(QuantityError::TooLarge { range: 0..5 }));
        assert_eq!(parse_quantity("1e300 GPa"), Err(QuantityError::TooLarge { range: 0..5 }));
    }

    #[test]
    fn the_fault_of_a_unit_is_placed_within_the_whole_text() {
        assert_eq!(parse_quantity("50 mm/sec").unwrap_err().range(), 6..9);
    }

    proptest! {
        #[test]
        fn no_text_panics_and_every_error_lies_within_it(text in "[ .e0-9a-z+-]{0,12}|\\PC{0,12}") {
            if let Err(error) = parse_quantity(&text) {
                prop_assert!(text.get(error.range()).is_some(), "{error:?}");
            }
        }

        #[test]
        fn a_formatted_value_reads_back(value in -1e4_f64..1e4, unit in prop::sample::select(&["mm", "deg", "ms", "N m/rad"])) {
            let quantity = parse_quantity(&format!("{value} {unit}")).unwrap();
            let back = parse_quantity(&quantity.to_string()).unwrap();
            prop_assert_eq!(back.dimension, quantity.dimension);
            prop_assert!((back.value_si - quantity.value_si).abs() <= 1e-5 * quantity.value_si.abs());
        }
    }
}
