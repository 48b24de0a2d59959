//! The axes of a sweep: parameters and keys that vary.

use vibrissa_runtime::machine::ParameterValue;
use vibrissa_runtime::units::Quantity;
use vibrissa_text::diagnostic::Span;
use vibrissa_world::scenario::Change;

/// A parameter or key that varies, with its values.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub(super) name: String,
    pub(super) values: AxisValues,
}

/// The values of an axis, at least one.
#[derive(Debug, Clone)]
pub(super) enum AxisValues {
    /// Values of a policy parameter.
    Parameter(Vec<AxisValue<ParameterValue>>),
    /// Values of a parameter of the families.
    Family(&'static str, Vec<AxisValue<Quantity>>),
    /// Values of a scenario key.
    Scenario(Vec<Change>),
}

/// A value of a parameter, as in the text.
#[derive(Debug, Clone)]
pub(super) struct AxisValue<T> {
    pub(super) value: T,
    /// The value as written in the sweep.
    pub(super) text: String,
    /// Its span in the sweep.
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
            Self::Family(_, values) => values.len(),
            Self::Scenario(changes) => changes.len(),
        }
    }

    /// The text of a value in keys of runs. `value` is an index below the number of values.
    pub(super) fn text(&self, value: usize) -> String {
        match self {
            Self::Parameter(values) => values[value].text.clone(),
            Self::Family(_, values) => values[value].text.clone(),
            Self::Scenario(changes) => changes[value].text(),
        }
    }
}
