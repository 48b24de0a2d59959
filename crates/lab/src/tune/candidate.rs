//! Values of the tuned parameters.

use std::collections::BTreeMap;
use std::sync::Arc;

use vibrissa_runtime::machine::{Program, SetError};

use super::axis::Axis;

/// A value for each tuned parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The names, texts and values (SI), in the order of the axes.
    values: Vec<(String, String, f64)>,
}

impl Candidate {
    /// The candidate at a point of the unit box.
    #[must_use]
    pub fn at(axes: &[Axis], point: &[f64]) -> Self {
        let value = |(axis, &coordinate): (&Axis, &f64)| {
            let (text, value) = axis.value(coordinate);
            (axis.name.clone(), text, value)
        };
        Self { values: axes.iter().zip(point).map(value).collect() }
    }

    /// The values (SI) that `of` gives for the parameters by name.
    pub fn new(axes: &[Axis], of: impl Fn(&str) -> Option<f64>) -> Self {
        let value = |axis: &Axis| {
            let (text, value) = axis.written(of(&axis.name).unwrap_or_default());
            (axis.name.clone(), text, value)
        };
        Self { values: axes.iter().map(value).collect() }
    }

    /// The point of the unit box.
    #[must_use]
    pub fn point(&self, axes: &[Axis]) -> Vec<f64> {
        axes.iter().zip(&self.values).map(|(axis, (.., value))| axis.coordinate(*value)).collect()
    }

    /// The values as texts, by name.
    #[must_use]
    pub fn settings(&self) -> BTreeMap<String, String> {
        self.values.iter().map(|(name, text, _)| (name.clone(), text.clone())).collect()
    }

    /// The value (SI) of a parameter, if it is tuned.
    pub(crate) fn value(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|(known, ..)| known == name).map(|&(.., value)| value)
    }

    /// The program with these values.
    ///
    /// # Errors
    /// [`SetError`] if the program does not have these parameters.
    pub(crate) fn program(&self, axes: &[Axis], program: &Program) -> Result<Arc<Program>, SetError> {
        let mut program = program.clone();
        for (axis, (name, _, value)) in axes.iter().zip(&self.values) {
            program.set(name, *value, axis.dimension)?;
        }
        Ok(Arc::new(program))
    }
}
