//! Lowering of the scenes of a property: the ranges of all parameters of its family.

use crate::ast::{Name, Range, Test};
use crate::suggestion::did_you_mean;
use crate::test::{ParameterRange, TestScenes};
use crate::unit::units_of;
use vibrissa_declare::catalogue::{self, Entry, common::SPEED};
use vibrissa_runtime::machine::Parameter;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;

impl<'f> Compiler<'f> {
    /// The scenes of a property over a `family`.
    pub(super) fn family(
        &mut self,
        family: &'f Name,
        ranges: &'f [Range],
        property: &'f Test,
        parameters: &[Parameter],
    ) -> Option<TestScenes> {
        let Some(entry) = catalogue::entry(&family.text) else {
            let message = format!("there is no family `{}`", family.text);
            let fault = Diagnostic::error("P0201", message, family.span, "unknown family of scenes");
            let names = || catalogue::ENTRIES.iter().map(|entry| entry.name);
            let fault = did_you_mean(fault, &family.text, names());
            self.report(fault.hint(format!("the families are {}", names().collect::<Vec<_>>().join(", "))));
            return None;
        };
        let mut named: Vec<ParameterRange> = Vec::new();
        for (index, range) in ranges.iter().enumerate() {
            if let Some(first) = ranges[..index].iter().find(|first| first.name.text == range.name.text) {
                let message = format!("`{}` has two ranges", range.name.text);
                let fault = Diagnostic::error("P0202", message, range.name.span, "again here");
                self.report(fault.note(first.name.span, "first here").hint("keep one of them"));
                return None;
            }
            named.push(self.range(entry, range)?);
        }
        let is_named = |name: &str| named.iter().any(|range| range.parameter.name == name);
        let others = entry.parameters.iter().filter(|parameter| !is_named(parameter.name));
        let others = others.map(|parameter| {
            let (low, high) = parameter.range;
            ParameterRange { parameter, low, high }
        });
        let ranges: Vec<ParameterRange> = others.chain(named.iter().copied()).collect();
        self.check_speed(family, property, &ranges, parameters)?;
        Some(TestScenes::Family { entry, ranges })
    }

    /// A range that a property names.
    fn range(&mut self, entry: &'static Entry, range: &'f Range) -> Option<ParameterRange> {
        let name = &range.name;
        let Some(parameter) = entry.parameter(&name.text) else {
            let message = format!("`{}` has no parameter `{}`", entry.name, name.text);
            let fault = Diagnostic::error("P0201", message, name.span, "unknown parameter of the family");
            let names = || entry.parameters.iter().map(|parameter| parameter.name);
            let fault = did_you_mean(fault, &name.text, names());
            self.report(fault.hint(format!("its parameters are {}", names().collect::<Vec<_>>().join(", "))));
            return None;
        };
        let low = self.bound(&range.low, range.high.as_ref())?;
        let high = match &range.high {
            Some(high) => self.bound(high, None)?,
            None => low,
        };
        let spans = [range.low.span, range.high.as_ref().unwrap_or(&range.low).span];
        for ((value, dimension), span) in [low, high].into_iter().zip(spans) {
            if dimension != parameter.dimension {
                let message = format!("`{}` is {}", name.text, parameter.dimension.phrase());
                let fault = Diagnostic::error("P0301", message, span, format!("is {}", dimension.phrase()));
                self.report(if parameter.dimension == Dimension::NUMBER {
                    fault.hint("write it without a unit")
                } else {
                    fault.hint(format!("give it a unit, such as {}", units_of(parameter.dimension).join(", ")))
                });
                return None;
            }
            if let Some(reason) = parameter.fault(value) {
                let message = format!("`{}` cannot be {}", name.text, parameter.text(value));
                let fault = Diagnostic::error("P0306", message, span, reason);
                self.report(fault.hint(format!("`{}`: {}", name.text, parameter.about)));
                return None;
            }
        }
        let ((low, _), (high, _)) = (low, high);
        if low > high {
            let message = format!("the range of `{}` has its minimum above its maximum", name.text);
            let label = format!("{} is more than {}", parameter.text(low), parameter.text(high));
            let fault = Diagnostic::error("P0306", message, spans[0].to(spans[1]), label);
            self.report(fault.hint(format!("write `{} .. {}`", parameter.text(high), parameter.text(low))));
            return None;
        }
        Some(ParameterRange { parameter, low, high })
    }

    /// Checks that the policy has a parameter `speed` for all speeds of the scenes.
    fn check_speed(
        &mut self,
        family: &Name,
        property: &'f Test,
        ranges: &[ParameterRange],
        parameters: &[Parameter],
    ) -> Option<()> {
        let set = property.settings.iter().find(|(name, _)| name.text == SPEED.name);
        if let Some((name, _)) = set {
            let message = "a property sets `speed` by its scenes";
            let fault = Diagnostic::error("P0704", message, name.span, "is set for every scene");
            self.report(fault.hint(format!("write `over {}(speed = 5 cm/s)`", family.text)));
            return None;
        }
        if let Some(None) = self.names().globals.get(SPEED.name) {
            // The error in the parameter has been reported.
            return None;
        }
        let Some(own) = parameters.iter().find(|parameter| parameter.name == SPEED.name) else {
            let message = "scenes of families set the policy's parameter `speed`";
            let fault = Diagnostic::error("P0704", message, family.span, "the policy has no such parameter");
            self.report(fault.hint("add it, such as `param speed = 50 mm/s in 1 .. 200 mm/s`"));
            return None;
        };
        let range = ranges.iter().find(|range| range.parameter.name == SPEED.name)?;
        for value in [range.low, range.high] {
            if let Err(error) = own.check(value, Dimension::SPEED) {
                let span = self.names().items.get(SPEED.name).copied();
                let message = "the policy does not allow all speeds of the scenes";
                let fault = Diagnostic::error("P0704", message, family.span, error.to_string());
                let (low, high) = own.range.unwrap_or((range.low, range.high));
                let (low, high) = (SPEED.text(low.max(range.low)), SPEED.text(high.min(range.high)));
                let fault = fault.hint(format!("write `over {}(speed in {low} .. {high})`", family.text));
                self.report(span.map_or(fault.clone(), |span: Span| fault.note(span, "the parameter")));
                return None;
            }
        }
        Some(())
    }
}
