//! One case of a property.

use crate::family::Values;
use vibrissa_declare::catalogue::Parameter;
use vibrissa_language::ParameterRange;

/// Values (SI) of all parameters of a family, in the order of the property's ranges.
#[derive(Debug, Clone, PartialEq)]
pub struct Case(Vec<(&'static Parameter, f64)>);

impl Case {
    pub(super) fn new(values: Vec<(&'static Parameter, f64)>) -> Self {
        Self(values)
    }

    /// The parameters with their values (SI).
    #[must_use]
    pub fn values(&self) -> &[(&'static Parameter, f64)] {
        &self.0
    }

    /// The values for the family.
    #[must_use]
    pub fn given(&self) -> Values {
        self.0.iter().map(|&(parameter, value)| (parameter.name, value)).collect()
    }

    /// The values that differ from those of the simplest scene in these ranges.
    #[must_use]
    pub fn notable(&self, ranges: &[ParameterRange]) -> String {
        let is_notable = |&(parameter, value): &(&Parameter, f64)| {
            let range = ranges.iter().find(|range| range.parameter.name == parameter.name);
            let simplest = range.map_or(parameter.simplest, |range| parameter.simplest.clamp(range.low, range.high));
            (value - simplest).abs() > 1e-6 * parameter.step
        };
        let notable = self.0.iter().copied().filter(is_notable);
        let notable: Vec<_> =
            notable.map(|(parameter, value)| format!("{} = {}", parameter.name, parameter.text(value))).collect();
        if notable.is_empty() { "the simplest scene".to_owned() } else { notable.join(", ") }
    }
}
