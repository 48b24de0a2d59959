//! Units as policies write them: words, with no blank between them.

use crate::units::{self, Dimension, UnitError, simple_units};

/// The units in which a quantity of this dimension is usually written, the most usual first.
pub(super) fn units_of(dimension: Dimension) -> Vec<String> {
    units::units_of(dimension).into_iter().map(|unit| unit.replace(' ', "*")).collect()
}

/// What to write instead of a text that is no unit.
pub(super) fn unit_hint(error: &UnitError) -> String {
    match error {
        UnitError::Unknown { suggestion: None, .. } => {
            // A share is a plain number here: there is no `%`.
            let words = simple_units().filter(|unit| unit.chars().all(|letter| letter.is_ascii_alphabetic()));
            format!("the units are {}", words.collect::<Vec<_>>().join(", "))
        }
        UnitError::Ambiguous { .. } => {
            "put products first and each divisor behind a slash of its own: N*m/rad, kg/m/s".to_owned()
        }
        _ => error.hint(),
    }
}
