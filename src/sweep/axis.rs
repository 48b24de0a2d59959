//! What varies in a sweep.

use crate::diagnostic::Span;
use crate::scenario::Change;
use vibrissa_runtime::units::Quantity;

/// Something that varies, with its values.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub(super) name: String,
    pub(super) values: AxisValues,
}

/// The values of something that varies; at least one.
#[derive(Debug, Clone)]
pub(super) enum AxisValues {
    /// Of a parameter of the policies.
    Parameter(Vec<ParameterValue>),
    /// Of a key of the scenarios.
    Scenario(Vec<Change>),
}

/// A value of a parameter.
#[derive(Debug, Clone)]
pub(super) struct ParameterValue {
    pub(super) quantity: Quantity,
    /// The same as it is written.
    pub(super) text: String,
    /// Where that is.
    pub(super) span: Span,
}

impl Axis {
    pub(super) fn len(&self) -> usize {
        self.values.len()
    }
}

impl AxisValues {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Parameter(values) => values.len(),
            Self::Scenario(changes) => changes.len(),
        }
    }

    /// A value (by its index, below their number) as it stands in keys.
    pub(super) fn text(&self, value: usize) -> String {
        match self {
            Self::Parameter(values) => values[value].text.clone(),
            Self::Scenario(changes) => changes[value].text(),
        }
    }
}
