//! Explicit values of parameters.

use std::collections::BTreeMap;

use vibrissa_declare::catalogue::Parameter;

/// Values (SI) of the parameters of a family, by name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Values(BTreeMap<&'static str, f64>);

impl Values {
    /// The value of a parameter, if it is given.
    pub(super) fn get(&self, parameter: &Parameter) -> Option<f64> {
        self.0.get(parameter.name).copied()
    }
}

impl FromIterator<(&'static str, f64)> for Values {
    fn from_iter<I: IntoIterator<Item = (&'static str, f64)>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}
