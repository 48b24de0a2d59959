//! Labels of transitions.

use super::wrap::wrapped;
use vibrissa_language::chart::{Argument, Chart, Guard, State, Target, Transition};

/// The label of "every state".
pub(super) const ANY_STATE: &str = "any state";

/// The label of the end of a run in failure.
pub(super) const FAILURE: &str = "Failure";

/// The label of the end of a run in success.
pub(super) const SUCCESS: &str = "Success";

/// Letters in a line.
pub(super) const LINE: usize = 40;

/// The label of a transition.
pub(super) struct Label {
    /// The position among the transitions of its origin, from 1. `None` if it is the only one.
    pub(super) number: Option<usize>,
    /// Its guard.
    pub(super) guard: String,
    /// Its effects: the arguments of the target, or the reason of the end.
    pub(super) effects: Vec<String>,
}

impl Label {
    /// The label of the transition with this index.
    pub(super) fn new(chart: &Chart, index: usize) -> Self {
        let transition = &chart.transitions[index];
        Self { number: transition.number, guard: guard(transition), effects: effects(chart, transition) }
    }

    /// The label of the arrow to an initial state, with the arguments of the state.
    pub(super) fn of_initial(chart: &Chart, state: usize) -> Self {
        let effects = given(chart, state, &chart.states[state].values).collect();
        Self { number: None, guard: String::new(), effects }
    }

    /// True if there is no text.
    pub(super) fn is_empty(&self) -> bool {
        self.guard.is_empty() && self.effects.is_empty()
    }

    /// The label in one line.
    pub(super) fn line(&self) -> String {
        let number = self.number.map(|number| number.to_string());
        let effects = (!self.effects.is_empty()).then(|| format!("/ {}", self.effects.join(", ")));
        let parts = number.into_iter().chain([self.guard.clone()]).chain(effects);
        parts.filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
    }

    /// The guard in lines of `width` letters.
    pub(super) fn guard_lines(&self, width: usize) -> Vec<String> {
        wrapped(&clauses(&self.guard), width)
    }

    /// The same without the first word, if that is the first word of most guards.
    pub(super) fn brief_guard_lines(&self, width: usize) -> Vec<String> {
        wrapped(&clauses(self.guard.strip_prefix("when ").unwrap_or(&self.guard)), width)
    }

    /// The effects in lines of `width` letters.
    pub(super) fn effect_lines(&self, width: usize) -> Vec<String> {
        wrapped(&listed(&self.effects), width)
    }
}

/// The clauses of a guard, one for each line if possible.
fn clauses(guard: &str) -> Vec<String> {
    let mut clauses = vec![String::new()];
    for word in guard.split_whitespace() {
        match clauses.last_mut() {
            Some(clause) if !["and", "or", "for"].contains(&word) => {
                clause.push_str(if clause.is_empty() { "" } else { " " });
                clause.push_str(word);
            }
            _ => clauses.push(word.to_owned()),
        }
    }
    clauses
}

/// The effects with their separators.
fn listed(effects: &[String]) -> Vec<String> {
    let last = effects.len().saturating_sub(1);
    let sign = |index| if index < last { "," } else { "" };
    let before = |index| if index == 0 { "/ " } else { "" };
    effects.iter().enumerate().map(|(k, effect)| format!("{}{effect}{}", before(k), sign(k))).collect()
}

/// A state's name and arguments.
pub(super) fn signature(state: &State) -> String {
    let own =
        if state.arguments.is_empty() { state.name.clone() } else { format!("{}({})", state.name, arguments(state)) };
    own + &behaviour(state).map_or_else(String::new, |behaviour| format!(" {behaviour}"))
}

/// The behaviour of a state, if it has one.
pub(super) fn behaviour(state: &State) -> Option<String> {
    state.behaviour.as_ref().map(|behaviour| format!("is {behaviour}"))
}

/// The number of inner states that are not shown. `None` if all are shown.
pub(super) fn hidden(state: &State) -> Option<String> {
    let plural = if state.hidden == 1 { "" } else { "s" };
    (state.hidden > 0).then(|| format!("+ {} state{plural} in it", state.hidden))
}

/// The name and arguments of a state, the number of inner states that are not shown, and its contracts.
pub(super) fn titled(state: &State) -> String {
    let contracts = (!state.contracts.is_empty()).then(|| state.contracts.join(", "));
    [Some(signature(state)), hidden(state), contracts].into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// The box for the global transitions, with the contracts of the machine.
pub(super) fn any_state(chart: &Chart) -> String {
    if chart.contracts.is_empty() {
        ANY_STATE.to_owned()
    } else {
        format!("{ANY_STATE}: {}", chart.contracts.join(", "))
    }
}

/// A state's arguments with their types.
pub(super) fn arguments(state: &State) -> String {
    let typed = |Argument { name, type_name }: &Argument| format!("{name}: {type_name}");
    state.arguments.iter().map(typed).collect::<Vec<_>>().join(", ")
}

fn guard(transition: &Transition) -> String {
    match &transition.guard {
        Guard::When { condition, lasting: None } => format!("when {condition}"),
        Guard::When { condition, lasting: Some(time) } => format!("when {condition} for {time}"),
        Guard::After(time) => format!("after {time}"),
        Guard::Failsafe => "failsafe".to_owned(),
        Guard::Exit(name) => format!("exit {name}"),
    }
}

fn effects(chart: &Chart, transition: &Transition) -> Vec<String> {
    let exits = transition.exits.iter().map(|exit| called(&format!("exit {}", exit.name), &exit.values));
    let mut effects: Vec<String> = exits.collect();
    effects.extend(target_effects(chart, &transition.target));
    effects
}

/// A name with its values.
fn called(name: &str, values: &[String]) -> String {
    if values.is_empty() { name.to_owned() } else { format!("{name}({})", values.join(", ")) }
}

fn target_effects(chart: &Chart, target: &Target) -> Vec<String> {
    match target {
        Target::Failure(reason) | Target::Success(reason) => vec![format!("\"{reason}\"")],
        Target::Exit { values, .. } => values.clone(),
        Target::State { state, outer, values, resume } => {
            let resumed = resume.then(|| "resume".to_owned()).into_iter();
            let outer = outer.iter().flat_map(|(outer, values)| given(chart, *outer, values));
            resumed.chain(outer).chain(given(chart, *state, values)).collect()
        }
    }
}

/// The argument values of a state, with the names of the arguments.
fn given<'c>(chart: &'c Chart, state: usize, values: &'c [String]) -> impl Iterator<Item = String> + use<'c> {
    let arguments = chart.states[state].arguments.iter();
    arguments.zip(values).map(|(argument, value)| format!("{} = {value}", argument.name))
}
