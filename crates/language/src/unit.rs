//! Units in the notation of policies: words without blanks between them.

use vibrissa_runtime::units::{self, Dimension, UnitError, format_si, simple_units};

/// The usual units of a quantity of this dimension, the most usual first.
pub(super) fn units_of(dimension: Dimension) -> Vec<String> {
    units::units_of(dimension).into_iter().map(|unit| unit.replace(' ', "*")).collect()
}

/// A value (SI) in the notation of policies.
pub(super) fn written(value_si: f64, dimension: Dimension) -> String {
    let text = format_si(value_si, dimension);
    text.split_once(' ').map_or_else(|| text.clone(), |(number, unit)| format!("{number} {}", unit.replace(' ', "*")))
}

/// Advice for a text that is not a unit.
pub(super) fn unit_hint(error: &UnitError) -> String {
    match error {
        UnitError::Unknown { instead: None, .. } => {
            // Shares are plain numbers in policies, without `%`.
            let words = simple_units().filter(|unit| unit.chars().all(|letter| letter.is_ascii_alphabetic()));
            format!("the units are {}", words.collect::<Vec<_>>().join(", "))
        }
        UnitError::Ambiguous { .. } => {
            "write products first, and a slash before each divisor: N*m/rad, kg/m/s".to_owned()
        }
        _ => error.hint(),
    }
}
