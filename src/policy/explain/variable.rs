//! Memory of a running machine, by names.

use vibrissa_runtime::machine::{Program, Register};
use vibrissa_runtime::units::{Dimension, format_si};

use crate::policy::types::{Type, Value};

/// A value that a machine or a state keeps from tick to tick: memory or an argument.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    value: Value,
}

/// The value of a variable in a tick.
#[derive(Debug, Clone, PartialEq)]
pub enum VariableValue {
    /// A number (SI) and its dimension.
    Number(f64, Dimension),
    /// A vector (SI) and its dimension.
    Vector([f64; 2], Dimension),
    /// A bool.
    Truth(bool),
    /// The name of a whisker or of a contour.
    Name(String),
}

impl Variable {
    pub(super) fn new((name, value): &(String, Value)) -> Self {
        Self { name: name.clone(), value: *value }
    }

    /// The value in the registers of a machine that runs `program`. `None` if the registers are not those of the program.
    #[must_use]
    pub fn value(&self, program: &Program, registers: &[f64]) -> Option<VariableValue> {
        let at = |register: Register| registers.get(usize::from(register)).copied();
        let value = at(self.value.register)?;
        Some(match self.value.r#type {
            Type::Scalar(dimension) => VariableValue::Number(value, dimension),
            Type::Vector(dimension) => VariableValue::Vector([value, at(self.value.register + 1)?], dimension),
            Type::Truth => VariableValue::Truth(value > 0.5),
            Type::Whisker | Type::Contour => {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "registers have indices of whiskers")]
                let index = value as usize;
                VariableValue::Name(program.contour_name(index)?.to_owned())
            }
            Type::Body | Type::Run => return None,
        })
    }
}

impl std::fmt::Display for VariableValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(value, dimension) => f.write_str(&format_si(*value, *dimension)),
            Self::Vector([x, y], dimension) => {
                write!(f, "({}, {})", format_si(*x, *dimension), format_si(*y, *dimension))
            }
            Self::Truth(truth) => write!(f, "{truth}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}
