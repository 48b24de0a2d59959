//! Parameters.

use crate::diagnostic::Diagnostic;
use crate::policy::ast::{Bound, Parameter};
use crate::policy::unit::{units_of, written};
use vibrissa_runtime::machine;
use vibrissa_runtime::units::{Dimension, parse_unit};

use super::Compiler;

impl<'f> Compiler<'f> {
    /// Checks a parameter. Parameters must be passed in the order of their indices.
    pub(super) fn parameter(&mut self, parameter: &'f Parameter) -> Option<machine::Parameter> {
        let (default, dimension) = self.bound(&parameter.value, None)?;
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
                                .note(parameter.value.span, format!("is {}", dimension.phrase()));
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
                let diagnostic = Diagnostic::error("P0306", message, parameter.value.span, label);
                self.report(diagnostic.note(range_span, "the range").hint(hint));
            }
        }
        Some(machine::Parameter {
            name: parameter.name.text.clone(),
            description: String::new(),
            dimension,
            default,
            range,
        })
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
