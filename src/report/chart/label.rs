//! What is written on a transition, and where in a chart it stands.

use super::wrap::wrapped;
use crate::policy::chart::{Argument, Chart, Guard, State, Target, Transition};

/// What stands for "every state".
pub(super) const ANY_STATE: &str = "any state";

/// What stands for the end of a run in failure.
pub(super) const FAILURE: &str = "Failure";

/// Letters in a line.
pub(super) const LINE: usize = 40;

/// What is written on a transition.
pub(super) struct Label {
    /// As the how manyth of its origin it is tried, from 1; `None` if it is the only one.
    pub(super) number: Option<usize>,
    /// When it is taken.
    pub(super) guard: String,
    /// What it hands over: the target's arguments, or the reason of the failure.
    pub(super) effects: Vec<String>,
}

impl Label {
    /// The label of the transition with this index.
    pub(super) fn new(chart: &Chart, index: usize) -> Self {
        let transition = &chart.transitions[index];
        Self { number: transition.number, guard: guard(transition), effects: effects(chart, transition) }
    }

    /// The label of the arrow to an initial state: nothing but what that is entered with.
    pub(super) fn of_initial(chart: &Chart, state: usize) -> Self {
        let effects = given(chart, state, &chart.states[state].values).collect();
        Self { number: None, guard: String::new(), effects }
    }

    /// Whether there is nothing to be written.
    pub(super) fn is_empty(&self) -> bool {
        self.guard.is_empty() && self.effects.is_empty()
    }

    /// All of it on one line.
    pub(super) fn line(&self) -> String {
        let number = self.number.map(|number| number.to_string());
        let effects = (!self.effects.is_empty()).then(|| format!("/ {}", self.effects.join(", ")));
        let parts = number.into_iter().chain([self.guard.clone()]).chain(effects);
        parts.filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
    }

    /// The guard in lines of so many letters.
    pub(super) fn guard_lines(&self, width: usize) -> Vec<String> {
        wrapped(&clauses(&self.guard), width)
    }

    /// The same without its first word, where that is one that most guards begin with.
    pub(super) fn brief_guard_lines(&self, width: usize) -> Vec<String> {
        wrapped(&clauses(self.guard.strip_prefix("when ").unwrap_or(&self.guard)), width)
    }

    /// What it hands over in lines of so many letters.
    pub(super) fn effect_lines(&self, width: usize) -> Vec<String> {
        wrapped(&listed(&self.effects), width)
    }
}

/// The clauses of a guard, which read best on a line each.
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

/// The effects with the signs that stand between them.
fn listed(effects: &[String]) -> Vec<String> {
    let last = effects.len().saturating_sub(1);
    let sign = |index| if index < last { "," } else { "" };
    let before = |index| if index == 0 { "/ " } else { "" };
    effects.iter().enumerate().map(|(k, effect)| format!("{}{effect}{}", before(k), sign(k))).collect()
}

/// A state's name and arguments.
pub(super) fn signature(state: &State) -> String {
    if state.arguments.is_empty() { state.name.clone() } else { format!("{}({})", state.name, arguments(state)) }
}

/// How many states in a state are not shown; nothing if all are.
pub(super) fn hidden(state: &State) -> Option<String> {
    let plural = if state.hidden == 1 { "" } else { "s" };
    (state.hidden > 0).then(|| format!("+ {} state{plural} in it", state.hidden))
}

/// A state's name and arguments, and how many states in it are not shown.
pub(super) fn titled(state: &State) -> String {
    [Some(signature(state)), hidden(state)].into_iter().flatten().collect::<Vec<_>>().join(" ")
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
    }
}

fn effects(chart: &Chart, transition: &Transition) -> Vec<String> {
    match &transition.target {
        Target::Failure(reason) => vec![format!("\"{reason}\"")],
        Target::State { state, outer, values, resume } => {
            let resumed = resume.then(|| "resume".to_owned()).into_iter();
            let outer = outer.iter().flat_map(|(outer, values)| given(chart, *outer, values));
            resumed.chain(outer).chain(given(chart, *state, values)).collect()
        }
    }
}

/// The values that a state is given, with the names of its arguments.
fn given<'c>(chart: &'c Chart, state: usize, values: &'c [String]) -> impl Iterator<Item = String> + use<'c> {
    let arguments = chart.states[state].arguments.iter();
    arguments.zip(values).map(|(argument, value)| format!("{} = {value}", argument.name))
}
