//! Memory of a running machine, by names.

use std::collections::HashMap;

use vibrissa_runtime::machine::{Program, Register};
use vibrissa_runtime::units::{Dimension, format_si};

use crate::types::{Type, Value};
use vibrissa_text::diagnostic::Span;

/// A value that a machine or a state keeps from tick to tick: memory or an argument.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    value: Value,
    /// The names of the values of its enumeration, if it has one.
    choices: Vec<String>,
}

/// The value of a variable in a tick.
#[derive(Debug, Clone, PartialEq)]
pub enum VariableValue {
    /// A number (SI) and its dimension.
    Number(f64, Dimension),
    /// A vector (SI) and its dimension.
    Vector([f64; 2], Dimension),
    /// A bool.
    Bool(bool),
    /// The name of a whisker, a contour or a value of an enumeration.
    Name(String),
}

impl Variable {
    /// `choices` are the names of the values of each enumeration, by the span of its name.
    pub(super) fn new((name, value): &(String, Value), choices: &HashMap<Span, Vec<String>>) -> Self {
        let names = match value.r#type {
            Type::Choice(of) => choices.get(&of.declared).cloned().unwrap_or_default(),
            _ => Vec::new(),
        };
        Self { name: name.clone(), value: *value, choices: names }
    }

    /// The value in the registers of a machine that runs `program`. `None` if the registers are not those of the program.
    #[must_use]
    pub fn value(&self, program: &Program, registers: &[f64]) -> Option<VariableValue> {
        let at = |register: Register| registers.get(usize::from(register)).copied();
        let value = at(self.value.register)?;
        Some(match self.value.r#type {
            Type::Scalar(dimension) => VariableValue::Number(value, dimension),
            r#type if let Some(dimension) = r#type.components() => {
                VariableValue::Vector([value, at(self.value.register + 1)?], dimension)
            }
            Type::Bool => VariableValue::Bool(value > 0.5),
            Type::Whisker | Type::Contour => VariableValue::Name(program.contour_name(index(value))?.to_owned()),
            Type::Choice(_) => VariableValue::Name(self.choices.get(index(value))?.clone()),
            _ => return None,
        })
    }
}

/// The index in a register.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the register contains an index")]
fn index(value: f64) -> usize {
    value as usize
}

impl std::fmt::Display for VariableValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(value, dimension) => f.write_str(&format_si(*value, *dimension)),
            Self::Vector([x, y], dimension) => {
                write!(f, "({}, {})", format_si(*x, *dimension), format_si(*y, *dimension))
            }
            Self::Bool(truth) => write!(f, "{truth}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}
