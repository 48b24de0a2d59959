//! Breakpoints of a run.

use crate::diagnostic::{Diagnostic, Source};
use crate::policy::explain::{Explained, explain};
use vibrissa_runtime::machine::{Guard, Register};

/// A condition or a state at which a run stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Breakpoint {
    /// The text: the name of a state, or a condition.
    pub text: String,
    pub(super) place: Place,
    /// Register of the time (s) for which a condition must hold.
    pub(super) lasting: Option<Register>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Place {
    /// The state with this index was entered.
    State(usize),
    /// A condition holds. It is the one of the global transition with this index.
    Condition(usize),
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
    /// Every other text is a condition, with or without a time after `for`. It may contain what a global transition may.
    ///
    /// # Errors
    /// Those of [`explain`], with the source to which they belong. It contains the breakpoints after the text of the policy.
    pub fn new(source: &Source, texts: &[String]) -> Result<Self, (Source, Vec<Diagnostic>)> {
        let plain = explain(source).map_err(|faults| (source.clone(), faults))?;
        let (states, first) = (&plain.program.states, plain.always.len());
        let state = |text: &String| states.iter().position(|state| *state.name == *text.trim());
        let conditions: Vec<&String> = texts.iter().filter(|text| state(text).is_none()).collect();
        let (mut breakpoints, mut next) = (Vec::with_capacity(texts.len()), first);
        for text in texts {
            let place = state(text).map_or(Place::Condition(next), Place::State);
            next += usize::from(matches!(place, Place::Condition(_)));
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
