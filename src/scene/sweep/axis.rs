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
        self.values.len()
    }
}

impl AxisValues {
    pub(in crate::scene) fn len(&self) -> usize {
        match self {
            Self::Parameter(values) => values.len(),
            Self::Scenario(changes) => changes.len(),
        }
    }

    /// A value (by its index, below their number) as it stands in keys.
    pub(in crate::scene) fn text(&self, value: usize) -> String {
        match self {
            Self::Parameter(values) => values[value].text.clone(),
            Self::Scenario(changes) => changes[value].text(),
        }
    }
}
