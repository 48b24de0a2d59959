//! The chart as text for Graphviz.

use super::label::{ANY_STATE, FAILURE, LINE, Label, SUCCESS, any_state, titled};
use super::lines::Lines;
use crate::report::style::printable;
use vibrissa_language::chart::{Chart, Origin, Target};

/// The node for the start of a run. The blanks in it distinguish it from names of states.
const START: &str = "start of the run";

/// The chart in Graphviz's language, for the layout program `dot`. The text of a transition is on its arrow. The reason
/// of an end, or the arguments of a state, follow a `/`.
#[must_use]
pub fn chart_dot(chart: &Chart) -> String {
    let mut lines = Lines::default();
    lines.block(&format!("digraph {}", quoted(&chart.machine)), |lines| {
        lines.push("node [shape=box, style=rounded, fontname=\"Helvetica\"]");
        lines.push("edge [fontname=\"Courier\", fontsize=10]");
        states(lines, chart, None);
        if chart.has_any_state() {
            let label = quoted(&any_state(chart));
            lines.push(&format!("{} [label={label}, style=\"rounded,dashed\"]", quoted(ANY_STATE)));
        }
        if chart.has_failure() {
            lines.push(&format!("{} [peripheries=2]", quoted(FAILURE)));
        }
        if chart.has_success() {
            lines.push(&format!("{} [peripheries=2]", quoted(SUCCESS)));
        }
        for (behaviour, name) in chart.ends() {
            lines.push(&format!("{} [peripheries=2]", quoted(&exit(behaviour, name))));
        }
        for (index, transition) in chart.transitions.iter().enumerate() {
            let from = match transition.origin {
                Origin::AnyState => ANY_STATE,
                Origin::State(state) => &chart.states[state].name,
            };
            let exit;
            let to = match &transition.target {
                Target::State { state, .. } => &chart.states[*state].name,
                Target::Failure(_) => FAILURE,
                Target::Success(_) => SUCCESS,
                Target::Exit { behaviour, name, .. } => {
                    exit = self::exit(behaviour, name);
                    &exit
                }
            };
            let label = label(&Label::new(chart, index));
            lines.push(&format!("{} -> {} [label=\"{label}\"]", quoted(from), quoted(to)));
        }
    });
    lines.finish()
}

/// The inner states of `parent`, with their own inner states.
fn states(lines: &mut Lines, chart: &Chart, parent: Option<usize>) {
    for (index, state) in chart.inside(parent) {
        let node = format!("{} [label={}]", quoted(&state.name), quoted(&titled(state)));
        if chart.inside(Some(index)).next().is_some() {
            lines.block(&format!("subgraph {}", quoted(&format!("cluster {}", state.name))), |lines| {
                lines.push(&node);
                states(lines, chart, Some(index));
            });
        } else {
            lines.push(&node);
        }
        if state.initial {
            let start = parent.map_or(START.to_owned(), |parent| format!("start of {}", chart.states[parent].name));
            lines.push(&format!("{} [shape=point, width=0.15]", quoted(&start)));
            let label = Label::of_initial(chart, index);
            let label = if label.is_empty() { String::new() } else { format!(" [label=\"{}\"]", self::label(&label)) };
            lines.push(&format!("{} -> {}{label}", quoted(&start), quoted(&state.name)));
        }
    }
}

/// The node of an exit. The blanks in it distinguish it from names of states.
fn exit(behaviour: &str, name: &str) -> String {
    format!("exit {name} of {behaviour}")
}

/// A label in left-aligned lines.
fn label(label: &Label) -> String {
    let mut lines = label.guard_lines(LINE);
    lines.extend(label.effect_lines(LINE));
    if let (Some(number), Some(first)) = (label.number, lines.first_mut()) {
        first.insert_str(0, &format!("{number} "));
    }
    lines.iter().map(|line| escaped(line) + "\\l").collect()
}

/// A text in quotes.
fn quoted(text: &str) -> String {
    format!("\"{}\"", escaped(text))
}

/// An escaped text. Graphviz interprets escapes and, in labels, XML's entities.
fn escaped(text: &str) -> String {
    printable(text).replace('\\', "\\\\").replace('"', "\\\"").replace('&', "&amp;")
}
