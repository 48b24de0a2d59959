//! The chart as text for Mermaid.

use super::label::{FAILURE, Label, SUCCESS, any_state, titled};
use super::lines::Lines;
use crate::report::style::printable;
use vibrissa_language::chart::{Chart, Origin, Target};

/// The chart as a `stateDiagram-v2` of Mermaid. The text of a transition is on its arrow. The reason of an end, or
/// the arguments of a state, follow a `/`.
#[must_use]
pub fn chart_mermaid(chart: &Chart) -> String {
    let mut lines = Lines::default();
    lines.push("stateDiagram-v2");
    states(&mut lines, chart, None);
    if chart.has_any_state() {
        lines.push(&format!("state \"{}\" as any", escaped(&any_state(chart))));
    }
    if chart.has_failure() {
        lines.push(&format!("state \"{FAILURE}\" as failure"));
    }
    if chart.has_success() {
        lines.push(&format!("state \"{SUCCESS}\" as success"));
    }
    for (index, (behaviour, name)) in chart.ends().into_iter().enumerate() {
        lines.push(&format!("state \"{}\" as e{index}", escaped(&format!("exit {name} of {behaviour}"))));
    }
    for (index, transition) in chart.transitions.iter().enumerate() {
        let from = match transition.origin {
            Origin::AnyState => "any".to_owned(),
            Origin::State(state) => id(state),
        };
        let to = match &transition.target {
            Target::State { state, .. } => id(*state),
            Target::Failure(_) => "failure".to_owned(),
            Target::Success(_) => "success".to_owned(),
            Target::Exit { behaviour, name, .. } => {
                let end = chart.ends().iter().position(|end| *end == (behaviour, name));
                format!("e{}", end.unwrap_or_default())
            }
        };
        lines.push(&format!("{from} --> {to}: {}", escaped(&Label::new(chart, index).line())));
    }
    if chart.has_failure() {
        lines.push("failure --> [*]");
    }
    if chart.has_success() {
        lines.push("success --> [*]");
    }
    lines.finish()
}

/// The inner states of `parent`, with their own inner states.
fn states(lines: &mut Lines, chart: &Chart, parent: Option<usize>) {
    for (index, state) in chart.inside(parent) {
        let head = format!("state \"{}\" as {}", escaped(&titled(state)), id(index));
        if chart.inside(Some(index)).next().is_some() {
            lines.block(&head, |lines| states(lines, chart, Some(index)));
        } else {
            lines.push(&head);
        }
        if state.initial {
            let label = Label::of_initial(chart, index);
            let label = if label.is_empty() { String::new() } else { format!(": {}", escaped(&label.line())) };
            lines.push(&format!("[*] --> {}{label}", id(index)));
        }
    }
}

/// The identifier of a state. Some names, such as `note`, are keywords of Mermaid.
fn id(state: usize) -> String {
    format!("s{state}")
}

/// An escaped text. Mermaid ends a text at `:` and `;`, and interprets Markdown and HTML. Its entities begin with `#`
/// instead of `&#`.
fn escaped(text: &str) -> String {
    let escape = |c: char| match c {
        '"' => "#quot;".to_owned(),
        '<' => "#lt;".to_owned(),
        _ if c.is_alphanumeric() || " .,()=+-/'|>!".contains(c) => c.to_string(),
        _ => format!("#{};", u32::from(c)),
    };
    printable(text).chars().map(escape).collect()
}
