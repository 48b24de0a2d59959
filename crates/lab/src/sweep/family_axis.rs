//! The axes of a sweep that vary parameters of families.

use super::axis::{AxisValue, AxisValues};
use super::scenes::{ScenesOf, SweepScenes};
use vibrissa_declare::catalogue::{self, Parameter};
use vibrissa_runtime::units::{Quantity, suggest};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_world::scenario::quantity;
use vibrissa_yaml::{Node, Placed, Reader, fault};

/// Reads the values of a parameter that all `scenes` must have.
pub(super) fn values(
    reader: &mut Reader<'_>,
    scenes: &[SweepScenes],
    name: &Placed<String>,
    items: &[Placed<Node>],
) -> Option<AxisValues> {
    if name.value == catalogue::common::SPEED.name {
        let message = "`speed` is also a parameter of the policies";
        let fault = Diagnostic::error(fault::ENTANGLED, message, name.span, "cannot be varied here");
        reader.report(fault.hint("vary it below `policy`; the families then use the same speed"));
        return None;
    }
    let parameters: Vec<_> = scenes.iter().map(|scenes| parameter(reader, scenes, name)).collect();
    let parameters: Vec<&Parameter> = parameters.into_iter().collect::<Option<_>>()?;
    let values: Vec<_> = items.iter().map(|item| value(reader, &parameters, item)).collect();
    Some(AxisValues::Family(parameters.first()?.name, values.into_iter().collect::<Option<_>>()?))
}

fn parameter(reader: &mut Reader<'_>, scenes: &SweepScenes, name: &Placed<String>) -> Option<&'static Parameter> {
    let ScenesOf::Family(family) = &scenes.of else {
        let message = format!("the scenario `{}` has no family whose parameters could vary", scenes.name());
        let fault = Diagnostic::error(fault::ENTANGLED, message, name.span, "is for families only");
        reader.report(fault.hint("sweep families and scenarios separately, or vary a key of the scenario"));
        return None;
    };
    let found = family.parameters.iter().find(|parameter| parameter.name == name.value);
    if found.is_none() {
        let message = format!("`{}` has no parameter `{}`", family.name, name.value);
        let fault = Diagnostic::error(fault::UNKNOWN_KEY, message, name.span, "unknown parameter");
        let names = || family.parameters.iter().map(|parameter| parameter.name);
        let fault = match suggest(&name.value, names()) {
            Some(meant) => fault.hint(format!("did you mean `{meant}`?")),
            None => fault,
        };
        let names: Vec<_> = names().collect();
        reader.report(fault.hint(format!("its parameters are {}", names.join(", "))));
    }
    found
}

/// Reads a value that all `parameters` allow.
fn value(reader: &mut Reader<'_>, parameters: &[&Parameter], item: &Placed<Node>) -> Option<AxisValue<Quantity>> {
    let (value, text) = quantity(reader, item)?;
    let value = AxisValue { value, text, span: reader.extent(item) };
    for parameter in parameters {
        if value.value.dimension != parameter.dimension {
            let message = format!("`{}` is not a value of `{}`", value.text, parameter.name);
            let label = format!("is {}", value.value.dimension.phrase());
            let fault = Diagnostic::error(fault::DIMENSION, message, value.span, label);
            reader.report(fault.hint(format!("for example `{}`", parameter.text(parameter.simplest))));
            return None;
        }
        if let Some(reason) = parameter.fault(value.value.value_si) {
            let message = format!("`{}` cannot be {}", parameter.name, value.text);
            reader.report(Diagnostic::error(fault::RANGE, message, value.span, reason));
            return None;
        }
    }
    Some(value)
}

/// The error of a family that has no scene with a value, at a span.
pub(super) fn no_scene(family: &str, span: Span, reason: &str) -> Diagnostic {
    let message = format!("`{family}` has no scene with this value");
    let fault = Diagnostic::error(fault::UNFIT, message, span, reason);
    fault.hint("choose another value; together with other values it can give objects that overlap")
}
