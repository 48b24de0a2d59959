//! Where a policy can go: states that cannot be reached, that cannot be left, that have no way to a failure.

use crate::diagnostic::Diagnostic;

use super::model::{Edge, Model};

/// Which states a run can come to, by transitions as they are written, whenever they are due.
pub(super) fn reachable(model: &Model<'_>) -> Vec<bool> {
    let mut reached = vec![false; model.states.len()];
    let mut open: Vec<usize> = model.always.iter().filter_map(Edge::leads_to).chain([model.program.initial]).collect();
    while let Some(state) = open.pop() {
        if !std::mem::replace(&mut reached[state], true) {
            open.extend(model.states[state].ways_out().flatten());
        }
    }
    reached
}

/// Warns of states that no run comes to.
pub(super) fn unreachable(model: &Model<'_>, warnings: &mut Vec<Diagnostic>) {
    let reached = reachable(model);
    for (index, state) in model.states.iter().enumerate().filter(|&(index, _)| !reached[index]) {
        let mut others = model.states.iter().enumerate().filter(|&(other, _)| other != index);
        let is_target = others.any(|(_, other)| other.ways_out().any(|target| target == Some(index)));
        let label = if is_target { "only states that cannot be reached lead here" } else { "no transition leads here" };
        let message = format!("the state `{}` cannot be reached", state.name.text);
        warnings.push(
            Diagnostic::warning("P0501", message, state.name.span, label)
                .hint("let a transition lead here, or leave the state out"),
        );
    }
}

/// Warns of states that a run cannot leave, and of those from which it cannot fail.
pub(super) fn without_a_way_out(model: &Model<'_>, warnings: &mut Vec<Diagnostic>) {
    let fails = |edge: &Edge<'_>| edge.leads_to().is_none();
    if model.always.iter().any(fails) {
        return;
    }
    let states = || model.states.iter().enumerate();
    // From the failures backwards: who leads there, who leads to those.
    let mut sources: Vec<Vec<usize>> = vec![Vec::new(); model.states.len()];
    for (index, state) in states() {
        for target in state.ways_out().chain(model.always.iter().map(Edge::leads_to)).flatten() {
            sources[target].push(index);
        }
    }
    let mut fallible = vec![false; model.states.len()];
    let mut open: Vec<usize> =
        states().filter(|(_, state)| state.ways_out().any(|target| target.is_none())).map(|(index, _)| index).collect();
    let has_failure = !open.is_empty();
    while let Some(state) = open.pop() {
        if !std::mem::replace(&mut fallible[state], true) {
            open.extend(&sources[state]);
        }
    }
    for (index, state) in states() {
        let name = &state.name.text;
        let mut ways_out = state.ways_out().chain(model.always.iter().map(Edge::leads_to));
        if ways_out.all(|target| target == Some(index)) {
            let message = format!("the state `{name}` cannot be left");
            warnings.push(Diagnostic::warning("P0502", message, state.name.span, "nothing leads out of it").hint(
                "write a transition, such as `after 60 s -> Failure(\"nothing more to do\")`, or an `always` rule",
            ));
        } else if has_failure && !fallible[index] {
            let message = format!("the state `{name}` has no way to `Failure`");
            warnings.push(no_failure(message, state.name.span));
        }
    }
    if !has_failure && !warnings.iter().any(|warning| warning.code == "P0502") {
        let message = "no state has a way to `Failure`".to_owned();
        warnings.push(no_failure(message, model.file.machine.span));
    }
}

fn no_failure(message: String, span: crate::diagnostic::Span) -> Diagnostic {
    Diagnostic::warning("P0503", message, span, "goes on whatever happens")
        .hint("say when to give up, such as `always when time > 300 s -> Failure(\"it takes too long\")`")
}
