//! What varies in a sweep.

use crate::diagnostic::Span;
use crate::scene::yaml::Change;
use crate::units::Quantity;

/// Something that varies, with its values.
#[derive(Debug, Clone)]
pub(in crate::scene) struct Axis {
    pub(in crate::scene) name: String,
    pub(in crate::scene) values: AxisValues,
}

/// The values of something that varies; at least one.
#[derive(Debug, Clone)]
pub(in crate::scene) enum AxisValues {
    /// Of a parameter of the policies.
    Parameter(Vec<ParameterValue>),
    /// Of a key of the scenarios.
    Scenario(Vec<Change>),
}

/// A value of a parameter.
#[derive(Debug, Clone)]
pub(in crate::scene) struct ParameterValue {
    pub(in crate::scene) quantity: Quantity,
    /// The same as it is written.
    pub(in crate::scene) text: String,
    /// Where that is.
    pub(in crate::scene) span: Span,
}

impl Axis {
    pub(super) fn len(&self) -> usize {
        match &self.values {
            AxisValues::Parameter(values) => values.len(),
            AxisValues::Scenario(changes) => changes.len(),
        }
    }
}

impl AxisValues {
    /// The values as they stand in keys.
    pub(in crate::scene) fn texts(&self) -> Vec<String> {
        match self {
            Self::Parameter(values) => values.iter().map(|value| value.text.clone()).collect(),
            Self::Scenario(changes) => changes.iter().map(Change::text).collect(),
        }
    }
}
