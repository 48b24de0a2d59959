//! The needs that a policy states.

use crate::ast::{File, Name, Need};
use crate::suggestion::did_you_mean;
use crate::unit::{units_of, written};
use vibrissa_runtime::machine::{Needs, RateRange};
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Diagnostic;

use super::Compiler;

/// The names of needs.
const CONTROL_RATE: &str = "control_rate";
const SAMPLE_RATE: &str = "sample_rate";
const SAMPLE_AGE: &str = "sample_age";
const NAMES: [&str; 3] = [CONTROL_RATE, SAMPLE_RATE, SAMPLE_AGE];

impl<'f> Compiler<'f> {
    /// Checks the needs of a policy.
    pub(super) fn needs(&mut self, file: &'f File) -> Needs {
        let (mut needs, mut seen): (Needs, Vec<&'f Name>) = (Needs::default(), Vec::new());
        for need in &file.needs {
            let name = &need.name;
            if let Some(first) = seen.iter().find(|first| first.text == name.text) {
                let message = format!("the need `{}` is stated twice", name.text);
                let diagnostic = Diagnostic::error("P0415", message, name.span, "stated again");
                self.report(diagnostic.note(first.span, "stated here").hint("keep one of them"));
                continue;
            }
            seen.push(name);
            let rates = |(low, high)| RateRange { low, high };
            match name.text.as_str() {
                CONTROL_RATE => needs.control_rate = self.need(need, Dimension::FREQUENCY).map(rates),
                SAMPLE_RATE => needs.sample_rate = self.need(need, Dimension::FREQUENCY).map(rates),
                SAMPLE_AGE => needs.sample_age = self.need(need, Dimension::TIME).map(|(_, oldest)| oldest),
                unknown => {
                    let message = format!("there is no need `{unknown}`");
                    let diagnostic = Diagnostic::error("P0415", message, name.span, "is none");
                    let list = NAMES.map(|name| format!("`{name}`")).join(", ");
                    self.report(did_you_mean(diagnostic, unknown, NAMES).hint(format!("needs are {list}")));
                }
            }
        }
        if let (Some(control), Some(sample)) = (needs.control_rate, needs.sample_rate)
            && !sample.has_multiple_of(&control)
        {
            let of = |name| file.needs.iter().find(|need| need.name.text == name).map_or(file.name.span, Need::range);
            let message = "no sample rate is a whole multiple of a control rate";
            let diagnostic = Diagnostic::error("P0416", message, of(SAMPLE_RATE), "sample rates");
            let hint = "every tick takes a whole number of samples; widen one of the ranges".to_owned();
            self.report(diagnostic.note(of(CONTROL_RATE), "control rates").hint(hint));
        }
        needs
    }

    /// The range of a need (SI), if it has the dimension and is valid.
    fn need(&mut self, need: &'f Need, dimension: Dimension) -> Option<(f64, f64)> {
        let name = &need.name.text;
        let (high, high_dimension) = self.bound(&need.high, None)?;
        // `in 20 .. 30 Hz`: the unit at the end applies to both bounds.
        let (low, low_dimension) = self.bound(&need.low, Some(&need.high))?;
        for (bound, found) in [(&need.high, high_dimension), (&need.low, low_dimension)] {
            if found != dimension {
                let message = format!("`{name}` is {}", dimension.phrase());
                let label = format!("is {}", found.phrase());
                let diagnostic = Diagnostic::error("P0301", message, bound.span, label);
                self.report(diagnostic.hint(format!("write it in {}", units_of(dimension).join(", "))));
                return None;
            }
        }
        let show = |value| written(value, dimension);
        let fault = |message: String, label: String, hint: String| {
            Some(Diagnostic::error("P0306", message, need.range(), label).hint(hint))
        };
        let fault = if low > high {
            fault(
                format!("the range of `{name}` has its minimum above its maximum"),
                format!("{} is more than {}", show(low), show(high)),
                format!("write `{} .. {}`", show(high), show(low)),
            )
        } else if high <= 0.0 {
            fault(format!("`{name}` must be positive"), format!("ends at {}", show(high)), {
                "write a greater maximum".to_owned()
            })
        } else if dimension == Dimension::TIME && low != 0.0 {
            fault(
                format!("the range of `{name}` must begin at 0"),
                format!("begins at {}", show(low)),
                format!("a sample is never too new: write `0 .. {}`", show(high)),
            )
        } else if dimension == Dimension::FREQUENCY && low <= 0.0 {
            fault(
                format!("the range of `{name}` must be positive"),
                format!("begins at {}", show(low)),
                "write the lowest rate at which the policy works".to_owned(),
            )
        } else {
            None
        };
        match fault {
            Some(fault) => {
                self.report(fault);
                None
            }
            None => Some((low, high)),
        }
    }
}
