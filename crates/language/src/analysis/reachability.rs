//! Reachability: states that cannot be reached or left, and states that cannot lead to the end of the run.

use vibrissa_text::diagnostic::Diagnostic;

use super::model::{Edge, Model};

/// The maximum of the number of states times transitions. Larger policies are not analysed, which bounds the time.
const PAIR_LIMIT: usize = 1_000_000;

/// For each state, true if it is reachable by transitions, whatever their guards.
pub(super) fn reachable(model: &Model<'_>) -> Vec<bool> {
    let program = model.program;
    // A state may be reached only as the outer state of an explicit target. Then its initial state is not reached.
    let mut reached = vec![false; model.states.len()];
    let mut entered = reached.clone();
    let always = model.always.iter().filter_map(Edge::leads_to);
    let mut open: Vec<usize> = always.chain([program.initial]).collect();
    while let Some(target) = open.pop() {
        if std::mem::replace(&mut entered[target], true) {
            continue;
        }
        open.extend(program.states[target].initial.iter().map(|&(inner, _)| inner));
        for state in program.outward(target) {
            if !std::mem::replace(&mut reached[state], true) {
                open.extend(model.states[state].exits().flatten());
            }
        }
    }
    reached
}

/// Warns about unreachable states. Inner states of an unreachable state are not reported.
pub(super) fn unreachable(model: &Model<'_>, warnings: &mut Vec<Diagnostic>) {
    let program = model.program;
    let reached = reachable(model);
    let is_told = |index: usize| program.states[index].parent.is_some_and(|parent| !reached[parent]);
    for (index, state) in model.states.iter().enumerate().filter(|&(index, _)| !reached[index] && !is_told(index)) {
        let mut others = model.states.iter().enumerate().filter(|&(other, _)| !program.contains(index, other));
        let is_target = others.any(|(other, node)| {
            let begins_here = program.states[other].initial.as_ref().is_some_and(|&(inner, _)| inner == index);
            begins_here || node.exits().flatten().any(|target| program.contains(index, target))
        });
        let label = if is_target { "only unreachable states lead here" } else { "no transition leads here" };
        let message = format!("the state `{}` cannot be reached", state.name.text);
        warnings.push(
            Diagnostic::warning("P0501", message, state.name.span, label)
                .hint("add a transition to it, or remove the state"),
        );
    }
}

/// Warns about states that a run cannot leave, and about those from which it cannot fail.
pub(super) fn without_exit(model: &Model<'_>, warnings: &mut Vec<Diagnostic>) {
    let ends = |edge: &&Edge<'_>| edge.leads_to().is_none();
    if model.always.iter().any(|edge| ends(&edge)) {
        return;
    }
    let program = model.program;
    let pairs = model.innermost().map(|(index, _)| {
        model.always.len() + program.outward(index).map(|state| model.states[state].edges.len()).sum::<usize>()
    });
    if pairs.sum::<usize>() > PAIR_LIMIT {
        return;
    }
    // A backward search from the ends of the run. A state that is resumed may continue in any of its inner states.
    let mut sources: Vec<Vec<usize>> = vec![Vec::new(); model.states.len()];
    let (mut is_left, mut open) = (vec![false; model.states.len()], Vec::new());
    for (index, node) in model.innermost() {
        let edges = model.active_edges(index);
        let can_end = edges.iter().any(ends) || node.exits().any(|target| target.is_none());
        open.extend(can_end.then_some(index));
        program.outward(index).for_each(|state| is_left[state] |= can_end);
        let failsafe = node.failsafe.and_then(|target| model.begins_in(target));
        let led = edges.into_iter().chain(&model.always).filter_map(|edge| model.leads_to_one(edge, index));
        for target in led.chain(failsafe) {
            sources[target].push(index);
            // From within a state, `resume` keeps the inner state.
            let leads_out = |state| !program.contains(state, target) && !program.contains(target, state);
            program.outward(index).for_each(|state| is_left[state] |= leads_out(state));
        }
    }
    let has_end = !open.is_empty();
    let mut ending = vec![false; model.states.len()];
    while let Some(innermost) = open.pop() {
        // An outer state can be left if one of its inner states can.
        for state in program.outward(innermost) {
            if !std::mem::replace(&mut ending[state], true) {
                open.extend(&sources[state]);
            }
        }
    }
    // A warning about a state also covers its inner states.
    let mut reported = vec![false; model.states.len()];
    for (index, state) in model.states.iter().enumerate() {
        let name = &state.name.text;
        reported[index] = program.states[index].parent.is_some_and(|parent| reported[parent]);
        if !is_left[index] {
            reported[index] = true;
            let message = format!("the state `{name}` cannot be left");
            warnings.push(Diagnostic::warning("P0502", message, state.name.span, "no transition leaves it").hint(
                "write a transition, such as `after 60 s -> Failure(\"nothing more to do\")`, or an `always` rule",
            ));
        } else if has_end && !ending[index] && !reported[index] {
            reported[index] = true;
            let message = format!("the state `{name}` cannot reach `Failure` or `Success`");
            warnings.push(no_end(message, state.name.span));
        }
    }
    if !has_end && !warnings.iter().any(|warning| warning.code == "P0502") {
        let message = "no state can reach `Failure` or `Success`".to_owned();
        warnings.push(no_end(message, model.file.name.span));
    }
}

fn no_end(message: String, span: vibrissa_text::diagnostic::Span) -> Diagnostic {
    Diagnostic::warning("P0503", message, span, "cannot end")
        .hint("add a transition to `Failure`, such as `always when time > 300 s -> Failure(\"it takes too long\")`")
}
