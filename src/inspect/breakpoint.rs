//! Breakpoints of a run.

use crate::diagnostic::{Diagnostic, Source};
use crate::policy::explain::{Explained, explain};
use vibrissa_runtime::machine::{Guard, Register, TIME_SLACK, TransitionId};

/// A condition, a state or a transition at which a run stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Breakpoint {
    /// The text: the name of a state, a transition, or a condition.
    pub text: String,
    pub(super) place: Place,
    /// Register of the time (s) for which a condition must hold.
    pub(super) lasting: Option<Register>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Place {
    /// The state with this index was entered.
    State(usize),
    /// A transition is taken.
    Transition(TransitionId),
    /// A condition holds. It is the one of the global transition with this index.
    Condition(usize),
}

/// What a tick did, for its breakpoints.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BreakpointTick<'t> {
    /// Its time (s).
    pub(crate) time: f64,
    /// The innermost active state.
    pub(crate) state: usize,
    /// True if that state was entered in the tick.
    pub(crate) has_entered: bool,
    /// The transitions that were taken.
    pub(crate) taken: &'t [TransitionId],
    /// The registers after the guards that were tried last.
    pub(crate) registers: &'t [f64],
}

/// The breakpoints during a run.
#[derive(Debug, Clone, Default)]
pub(crate) struct BreakpointWatch {
    /// For each breakpoint, the time (s) since which its condition holds.
    holding_since: Vec<Option<f64>>,
    /// True for each breakpoint that the tick before hit.
    were_hit: Vec<bool>,
}

impl BreakpointWatch {
    /// The first breakpoint that a tick hits. A condition that goes on holding hits once.
    pub(crate) fn hit<'b>(&mut self, policy: &'b Breakpoints, tick: &BreakpointTick<'_>) -> Option<&'b Breakpoint> {
        let (explained, count) = (&policy.explained, policy.breakpoints.len());
        self.holding_since.resize(count, None);
        self.were_hit.resize(count, false);
        let mut first = None;
        let states = self.holding_since.iter_mut().zip(&mut self.were_hit);
        for (breakpoint, (since, was_hit)) in policy.breakpoints.iter().zip(states) {
            let is_hit = match breakpoint.place {
                Place::State(wanted) => tick.has_entered && explained.program.contains(wanted, tick.state),
                Place::Transition(transition) => tick.taken.contains(&transition),
                Place::Condition(index) => {
                    let condition = explained.always.get(index).and_then(|always| always.condition.as_ref());
                    let is_met = condition.is_some_and(|condition| condition.missing(tick.registers).is_empty());
                    *since = is_met.then(|| since.unwrap_or(tick.time));
                    let needed = breakpoint.lasting.and_then(|register| tick.registers.get(usize::from(register)));
                    let needed = needed.copied().unwrap_or(0.0);
                    since.is_some_and(|since| tick.time - since >= needed - TIME_SLACK)
                }
            };
            let goes_on = std::mem::replace(was_hit, is_hit) && matches!(breakpoint.place, Place::Condition(_));
            if is_hit && !goes_on {
                first = first.or(Some(breakpoint));
            }
        }
        first
    }
}

/// An explained policy with breakpoints.
#[derive(Debug)]
pub struct Breakpoints {
    /// The policy. Its global transitions include those of the breakpoints, which are never taken.
    pub explained: Explained,
    /// The breakpoints.
    pub breakpoints: Vec<Breakpoint>,
}

impl Breakpoints {
    /// Explains a policy and adds breakpoints to it. A text that is the name of a state stops the run when that state is entered.
    /// The name of a state, a colon and one of its guards stops it when that transition is taken. Every other text is a condition,
    /// with or without a time after `for`. It may contain what a global transition may.
    ///
    /// # Errors
    /// Those of [`explain`], with the source to which they belong. It contains the breakpoints after the text of the policy.
    pub fn new(source: &Source, texts: &[String]) -> Result<Self, (Source, Vec<Diagnostic>)> {
        let plain = explain(source).map_err(|faults| (source.clone(), faults))?;
        let (states, first) = (&plain.program.states, plain.always.len());
        let state = |text: &String| states.iter().position(|state| *state.name == *text.trim());
        let (mut breakpoints, mut next, mut conditions) = (Vec::with_capacity(texts.len()), first, Vec::new());
        for text in texts {
            let transition = || transition(&plain, text).map(Place::Transition);
            let place = state(text).map(Place::State).or_else(transition).unwrap_or(Place::Condition(next));
            if let Place::Condition(_) = place {
                next += 1;
                conditions.push(text);
            }
            breakpoints.push(Breakpoint { text: text.clone(), place, lasting: None });
        }
        if conditions.is_empty() {
            return Ok(Self { explained: plain, breakpoints });
        }
        let whole = with_conditions(source, &conditions);
        let mut explained = explain(&whole).map_err(|faults| (whole, faults))?;
        for breakpoint in &mut breakpoints {
            if let Place::Condition(index) = breakpoint.place
                && let Some(Guard::When { lasting, .. }) = explained.program.always.get(index).map(|one| &one.guard)
            {
                breakpoint.lasting = lasting.map(|(duration, _)| duration);
            }
        }
        disable(&mut explained, first);
        Ok(Self { explained, breakpoints })
    }
}

impl Breakpoint {
    /// The state whose entry stops the run, if it is one.
    #[must_use]
    pub fn state(&self) -> Option<usize> {
        if let Place::State(state) = self.place { Some(state) } else { None }
    }

    /// The transition that stops the run, if it is one.
    #[must_use]
    pub fn transition(&self) -> Option<TransitionId> {
        if let Place::Transition(transition) = self.place { Some(transition) } else { None }
    }
}

/// The transition that a text names by its state and its guard.
fn transition(policy: &Explained, text: &str) -> Option<TransitionId> {
    let (name, guard) = text.split_once(':')?;
    let state = policy.program.states.iter().position(|state| *state.name == *name.trim())?;
    let index = policy.states.get(state)?.iter().position(|one| one.text == guard.trim())?;
    Some(TransitionId { state: Some(state), index })
}

/// A policy with a global transition for each condition, after its other items.
fn with_conditions(source: &Source, conditions: &[&String]) -> Source {
    let mut text = source.slice(source.part_span(0)).to_owned();
    for condition in conditions {
        text.extend(["\nalways when ", condition, " -> Failure(\"breakpoint\")"]);
    }
    let mut whole = Source::new(source.name.as_str(), text);
    for part in 1..source.count() {
        let text = source
            .absence(part)
            .map_or_else(|| Ok(source.slice(source.part_span(part))), |absence| Err(absence.to_owned()));
        whole.add(source.part_name(part), text);
    }
    whole
}

/// Keeps the global transitions from `first` on from being taken. Their conditions are still computed.
fn disable(explained: &mut Explained, first: usize) {
    let program = &mut explained.program;
    let Ok(never) = u16::try_from(program.initial_registers.len()) else { return };
    program.initial_registers.push(0.0);
    for transition in program.always.iter_mut().skip(first) {
        if let Guard::When { truth, .. } = &mut transition.guard {
            *truth = never;
        }
    }
}
