//! Changes of a policy for a counterfactual: other values of parameters and of thresholds.

use std::collections::BTreeMap;
use std::sync::Arc;

use vibrissa_runtime::machine::Program;

use super::message::ParameterInfo;
use crate::inspect::Breakpoints;
use vibrissa_language::explain::Threshold;

/// The values that may be changed.
#[derive(Debug, Clone, Default)]
pub struct Changeable {
    /// The thresholds by their names.
    thresholds: BTreeMap<String, Threshold>,
}

impl Changeable {
    /// The values of a program that may be changed, with what a page shows of them. `number` gives the number of a threshold's guard.
    pub fn new(
        program: &Program,
        thresholds: Vec<Threshold>,
        number: impl Fn(&Threshold) -> Option<usize>,
    ) -> (Self, Vec<ParameterInfo>) {
        let parameters = program.parameters.iter().zip(&program.initial_registers).map(|(parameter, &value)| {
            let (low, high) = parameter.range.unzip();
            ParameterInfo {
                name: parameter.name.clone(),
                value,
                unit: parameter.dimension.si_unit(),
                low,
                high,
                choices: parameter.choices.clone(),
                meaning: parameter.description.clone(),
                guard: None,
            }
        });
        let mut infos: Vec<ParameterInfo> = parameters.collect();
        let mut known = BTreeMap::new();
        for threshold in thresholds {
            let Some(guard) = number(&threshold) else { continue };
            let part = threshold.part.map_or_else(|| "time".to_owned(), |part| format!("part {part}"));
            let name = format!("guard {guard}, {part}");
            infos.push(ParameterInfo {
                name: name.clone(),
                value: threshold.value,
                unit: threshold.dimension.si_unit(),
                low: None,
                high: None,
                choices: Vec::new(),
                meaning: threshold.text.clone(),
                guard: Some(guard),
            });
            known.insert(name, threshold);
        }
        (Self { thresholds: known }, infos)
    }

    /// The program of a run with changed values. Its registers are those of `program`, and further ones after them.
    ///
    /// # Errors
    /// What is wrong with a value, for people.
    pub fn apply(
        &self,
        program: &Program,
        policy: Option<&Breakpoints>,
        values: &BTreeMap<String, f64>,
    ) -> Result<Arc<Program>, String> {
        let mut changed = program.clone();
        for (name, &value) in values {
            if !value.is_finite() {
                return Err(format!("`{name}` must be a finite number"));
            }
            if let (Some(threshold), Some(policy)) = (self.thresholds.get(name), policy) {
                let Threshold { transition, part, .. } = *threshold;
                let set = policy.explained.set_threshold(&mut changed, transition, part, value);
                set.map_err(|error| format!("{name}: {error}"))?;
                continue;
            }
            let index = changed.parameters.iter().position(|parameter| parameter.name == *name);
            let Some((index, parameter)) = index.and_then(|index| Some((index, changed.parameters.get(index)?))) else {
                return Err(format!("there is neither a parameter nor a threshold `{name}`; choose one of the list"));
            };
            if parameter.choices.is_empty() {
                parameter.check(value, parameter.dimension).map_err(|error| error.to_string())?;
            } else if !(0..parameter.choices.len()).any(|choice| (choice as f64).to_bits() == value.to_bits()) {
                return Err(format!("`{name}` has {} choices, numbered from 0", parameter.choices.len()));
            }
            if let Some(register) = changed.initial_registers.get_mut(index) {
                *register = value;
            }
        }
        Ok(Arc::new(changed))
    }
}
