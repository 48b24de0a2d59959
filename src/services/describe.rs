//! The description of a policy on the dashboard, in Markdown.

use std::fmt::Write;

use vibrissa_runtime::machine::{Parameter, Program};
use vibrissa_runtime::units::format_si;

/// States, whiskers, parameters and plots of a program.
pub(super) fn describe(program: &Program) -> String {
    let mut text = format!("**{}** with the whiskers {}.\n\n", program.name, program.whiskers.join(", "));
    text.push_str("| parameter | default | range | meaning |\n|---|---|---|---|\n");
    for parameter in &program.parameters {
        let description = parameter.description.replace('|', "/");
        let (value, range) = (value(parameter, parameter.default), range(parameter));
        // Writing to a string does not fail.
        let _ = writeln!(text, "| {} | {value} | {range} | {description} |", parameter.name);
    }
    if !program.outputs.plots.is_empty() {
        let plots: Vec<&str> = program.outputs.plots.iter().map(|plot| plot.name.as_str()).collect();
        let _ =
            write!(text, "\nThe policy plots {}. They are in recordings, and not in the telemetry.", plots.join(", "));
    }
    text
}

fn value(parameter: &Parameter, value: f64) -> String {
    let choice = parameter.choices.iter().enumerate().find(|(index, _)| (*index as f64 - value).abs() < 0.5);
    choice.map_or_else(|| format_si(value, parameter.dimension), |(_, choice)| choice.clone())
}

fn range(parameter: &Parameter) -> String {
    match parameter.range {
        _ if !parameter.choices.is_empty() => parameter.choices.join(", "),
        Some((low, high)) => format!("{} to {}", value(parameter, low), value(parameter, high)),
        None => String::new(),
    }
}
