//! A parameter that is tuned.

use vibrissa_runtime::machine::{Parameter, Program};
use vibrissa_runtime::math;
use vibrissa_runtime::units::{Dimension, format_si, parse_quantity};

/// Ranges with a larger ratio of their ends have a logarithmic scale.
const LOGARITHMIC_FROM: f64 = 8.0;

/// A parameter of a policy with its range, as a coordinate from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the parameter.
    pub name: String,
    /// Its dimension.
    pub(crate) dimension: Dimension,
    low: f64,
    high: f64,
    is_logarithmic: bool,
}

/// The error of a parameter that cannot be tuned.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum AxisError {
    /// The policy does not have it.
    #[error("the policy has no parameter `{name}`; it has {known}")]
    Unknown {
        /// Its name.
        name: String,
        /// The names of all parameters.
        known: String,
    },
    /// It has no range, or one without extent.
    #[error("the parameter `{name}` has no range to search; declare one: param {name} = ... in LOW .. HIGH")]
    NoRange {
        /// Its name.
        name: String,
    },
    /// It was named twice.
    #[error("the parameter `{name}` is named twice; name each parameter once")]
    Twice {
        /// Its name.
        name: String,
    },
    /// No parameter has a range.
    #[error(
        "no parameter of the policy is a number with a range to search; declare one: param NAME = ... in LOW .. HIGH"
    )]
    None,
}

impl Axis {
    /// The parameters with these names, or all with a range if there are no names.
    ///
    /// # Errors
    /// [`AxisError`] if a parameter cannot be tuned.
    pub fn of(program: &Program, names: &[String]) -> Result<Vec<Self>, AxisError> {
        if names.is_empty() {
            let all: Vec<Self> = program.parameters.iter().filter_map(Self::new).collect();
            return if all.is_empty() { Err(AxisError::None) } else { Ok(all) };
        }
        let axis = |(index, name): (usize, &String)| {
            if names.iter().take(index).any(|earlier| earlier == name) {
                return Err(AxisError::Twice { name: name.clone() });
            }
            let known =
                || program.parameters.iter().map(|one| format!("`{}`", one.name)).collect::<Vec<_>>().join(", ");
            let parameter = program.parameters.iter().find(|parameter| parameter.name == *name);
            let parameter = parameter.ok_or_else(|| AxisError::Unknown { name: name.clone(), known: known() })?;
            Self::new(parameter).ok_or_else(|| AxisError::NoRange { name: name.clone() })
        };
        names.iter().enumerate().map(axis).collect()
    }

    fn new(parameter: &Parameter) -> Option<Self> {
        let (low, high) = parameter.range.filter(|(low, high)| low < high && parameter.choices.is_empty())?;
        let is_logarithmic = low > 0.0 && high / low > LOGARITHMIC_FROM;
        Some(Self { name: parameter.name.clone(), dimension: parameter.dimension, low, high, is_logarithmic })
    }

    /// The coordinate (0 to 1) of a value (SI).
    pub(crate) fn coordinate(&self, value: f64) -> f64 {
        let share = if self.is_logarithmic {
            math::ln(value / self.low) / math::ln(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        };
        share.clamp(0.0, 1.0)
    }

    /// The value at a coordinate (0 to 1), as text and in SI units. The text is short, and reads as exactly this value.
    pub(crate) fn value(&self, coordinate: f64) -> (String, f64) {
        let value = if self.is_logarithmic {
            self.low * math::powf(self.high / self.low, coordinate)
        } else {
            self.low + coordinate * (self.high - self.low)
        };
        self.written(value)
    }

    /// A value (SI) as text, and the value of this text.
    pub(crate) fn written(&self, value: f64) -> (String, f64) {
        let value = value.clamp(self.low, self.high);
        // Four digits are enough for a policy, and short in its text.
        let short = format!("{value:.3e}").parse().unwrap_or(value);
        let text = format_si(short, self.dimension);
        match parse_quantity(&text) {
            Ok(read) if (self.low..=self.high).contains(&read.value_si) => (text, read.value_si),
            // Rounding has left the range.
            _ if self.dimension == Dimension::NUMBER => (value.to_string(), value),
            _ => (format!("{value} {}", self.dimension.si_unit()), value),
        }
    }

    /// The range as text.
    #[must_use]
    pub fn range(&self) -> String {
        let [low, high] = [self.low, self.high].map(|end| format_si(end, self.dimension));
        format!("{low} .. {high}")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;
    use vibrissa_text::diagnostic::Source;

    fn axes(names: &[&str]) -> Result<Vec<Axis>, AxisError> {
        let text = "machine m  param speed = 5 cm/s in 1 mm/s .. 200 mm/s  param tilt = 10 deg in -30 deg .. 45 deg\n\
            param share = 0.5 in 0.1 .. 0.7  param free = 1 s\n\
            initial A  state A { steer body along direction(body.yaw) at speed turning 0 deg/s  when share > 0.2 -> B }\n\
            state B { stop  when body.yaw > tilt for free -> A }";
        let program = vibrissa_language::compile(&Source::new("m.fsm", text)).unwrap();
        Axis::of(&program, &names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>())
    }

    proptest! {
        #[test]
        fn a_text_reads_as_its_value_and_is_near_the_coordinate(coordinate in 0.0..=1.0) {
            for axis in axes(&[]).unwrap() {
                let (text, value) = axis.value(coordinate);
                prop_assert_eq!(parse_quantity(&text).unwrap().value_si.to_bits(), value.to_bits(), "{}", text);
                prop_assert!((axis.low..=axis.high).contains(&value));
                prop_assert!((axis.coordinate(value) - coordinate).abs() < 2e-3, "{}", text);
            }
        }
    }

    #[test]
    fn only_parameters_with_a_range_are_tuned() {
        let names: Vec<String> = axes(&[]).unwrap().into_iter().map(|axis| axis.name).collect();
        assert_eq!(names, ["speed", "tilt", "share"]);
        assert_eq!(axes(&["free"]).unwrap_err(), AxisError::NoRange { name: "free".to_owned() });
        assert_eq!(axes(&["tilt", "tilt"]).unwrap_err(), AxisError::Twice { name: "tilt".to_owned() });
        assert!(matches!(axes(&["none"]).unwrap_err(), AxisError::Unknown { .. }));
    }
}
