//! Parameters.

use crate::ast::{Bound, Enumeration, Name, Parameter, Setting};
use crate::suggestion::did_you_mean;
use crate::types::Type;
use crate::unit::{units_of, written};
use vibrissa_runtime::machine::{self, ParameterValue};
use vibrissa_runtime::units::{Dimension, Quantity, parse_unit};
use vibrissa_text::diagnostic::Diagnostic;

use super::Compiler;

impl<'f> Compiler<'f> {
    /// Checks a parameter. Returns its type, too. Parameters must be passed in the order of their indices.
    pub(super) fn parameter(&mut self, parameter: &'f Parameter) -> Option<(machine::Parameter, Type)> {
        let (choices, r#type, number) = match &parameter.value {
            Setting::Number(value) => return self.number(parameter, value),
            Setting::Bool(truth, _) => (["false", "true"].map(str::to_owned).to_vec(), Type::Bool, usize::from(*truth)),
            Setting::Choice(of, value) => {
                let item = self.enumeration(of)?;
                (self.choice_names(item), item.r#type(), self.choice_number(item, value)?)
            }
        };
        let range = Some((0.0, choices.len() as f64 - 1.0));
        let (name, default) = (parameter.name.text.clone(), number as f64);
        let (description, dimension) = (String::new(), Dimension::NUMBER);
        Some((machine::Parameter { name, description, dimension, default, range, choices }, r#type))
    }

    /// The enumeration with a name.
    fn enumeration(&mut self, of: &Name) -> Option<&'f Enumeration> {
        let found = self.names().enumerations.get(of.text.as_str()).copied();
        if found.is_none() {
            let message = format!("there is no type `{}`", of.text);
            let diagnostic = Diagnostic::error("P0204", message, of.span, "unknown type");
            let known: Vec<&str> = self.names().enumerations.keys().copied().collect();
            let diagnostic = did_you_mean(diagnostic, &of.text, known);
            self.report(diagnostic.hint(format!("declare its values: `type {} = left or right`", of.text)));
        }
        found
    }

    /// The value of a parameter that a test sets, as a run sets it.
    pub(super) fn value_of(&mut self, setting: &'f Setting, parameter: &machine::Parameter) -> Option<f64> {
        let value = match setting {
            Setting::Number(bound) => {
                let (value_si, dimension) = self.bound(bound, None)?;
                ParameterValue::Quantity(Quantity { value_si, dimension, unit: None })
            }
            Setting::Bool(truth, _) => ParameterValue::Choice(truth.to_string()),
            Setting::Choice(of, value) => {
                let item = self.enumeration(of)?;
                self.choice_number(item, value)?;
                let known = self.names().globals.get(parameter.name.as_str()).copied().flatten();
                if let Some(found) = known.map(|known| known.r#type).filter(|&found| found != item.r#type()) {
                    let message =
                        format!("`{}` is {}, not {}", parameter.name, self.phrase(found), self.phrase(item.r#type()));
                    let diagnostic = Diagnostic::error("P0301", message, setting.span(), "cannot be set");
                    self.report(
                        diagnostic.hint(format!("write a value such as `{}`", parameter.text(parameter.default))),
                    );
                    return None;
                }
                ParameterValue::Choice(value.text.clone())
            }
        };
        let read = parameter.read(&value);
        if let Err(error) = &read {
            let diagnostic = Diagnostic::error("P0306", error.to_string(), setting.span(), "cannot be set");
            self.report(match self.names().items.get(parameter.name.as_str()) {
                Some(&made) => diagnostic.note(made, "the parameter"),
                None => diagnostic,
            });
        }
        read.ok()
    }

    fn number(&mut self, parameter: &'f Parameter, value: &'f Bound) -> Option<(machine::Parameter, Type)> {
        let (default, dimension) = self.bound(value, None)?;
        let range = match &parameter.range {
            None => None,
            Some((low, high)) => {
                let (high_value, high_dimension) = self.bound(high, None)?;
                // `in 1 .. 200 mm/s`: the unit at the end applies to both bounds.
                let (low_value, low_dimension) = self.bound(low, Some(high))?;
                for (bound, found) in [(high, high_dimension), (low, low_dimension)] {
                    if found != dimension {
                        let message = format!("the range of `{}` is in another dimension", parameter.name.text);
                        let diagnostic =
                            Diagnostic::error("P0301", message, bound.span, format!("is {}", found.phrase()))
                                .note(value.span, format!("is {}", dimension.phrase()));
                        self.report(diagnostic.hint(units_hint(dimension, found)));
                        return None;
                    }
                }
                Some((low_value, high_value))
            }
        };
        if let (Some((low, high)), Some((low_bound, high_bound))) = (range, &parameter.range) {
            let show = |value| written(value, dimension);
            let range_span = low_bound.span.to(high_bound.span);
            if low > high {
                let message = format!("the range of `{}` has its minimum above its maximum", parameter.name.text);
                let label = format!("{} is more than {}", show(low), show(high));
                let diagnostic = Diagnostic::error("P0306", message, range_span, label);
                self.report(diagnostic.hint(format!("write `{} .. {}`", show(high), show(low))));
            } else if !(low..=high).contains(&default) {
                let message = format!("`{}` is not in its own range", parameter.name.text);
                let (nearest, than) = if default < low { (low, "less") } else { (high, "more") };
                let label = format!("{} is {than} than {}", show(default), show(nearest));
                let hint = format!(
                    "give it a value within that, such as `{}`, or a wider range: `{} .. {}`",
                    show(nearest),
                    show(low.min(default)),
                    show(high.max(default))
                );
                let diagnostic = Diagnostic::error("P0306", message, value.span, label);
                self.report(diagnostic.note(range_span, "the range").hint(hint));
            }
        }
        let (name, description, choices) = (parameter.name.text.clone(), String::new(), Vec::new());
        let checked = machine::Parameter { name, description, dimension, default, range, choices };
        Some((checked, Type::Scalar(dimension)))
    }

    /// The SI value and dimension of a bound. Without a unit of its own, the bound takes that of `other`.
    pub(super) fn bound(&mut self, bound: &'f Bound, other: Option<&'f Bound>) -> Option<(f64, Dimension)> {
        let (mut value, mut dimension) = self.quantity(&bound.quantity)?;
        if let (None, Some(unit)) = (&bound.quantity.unit, other.and_then(|other| other.quantity.unit.as_ref()))
            && let Ok(unit) = parse_unit(&unit.text.replace('*', " "))
        {
            (value, dimension) = (unit.to_si(value), unit.dimension());
        }
        Some((if bound.negative { -value } else { value }, dimension))
    }
}

/// Advice for a value and a range with different dimensions.
fn units_hint(value: Dimension, range: Dimension) -> String {
    let units = |dimension| units_of(dimension).join(", ");
    match (value, range) {
        (Dimension::NUMBER, other) => format!("give the value a unit, such as {}", units(other)),
        (other, Dimension::NUMBER) => format!("give the upper end of the range a unit, such as {}", units(other)),
        _ => format!("write both in {}, or both in {}", units(value), units(range)),
    }
}
