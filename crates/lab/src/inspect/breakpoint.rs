//! Breakpoints of a run.

use vibrissa_language::explain::{Explained, explain};
use vibrissa_runtime::machine::{Guard, Register, TIME_SLACK, TransitionId};
use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

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
pub struct BreakpointTick<'t> {
    /// Its time (s).
    pub time: f64,
    /// The innermost active state.
    pub state: usize,
    /// True if that state was entered in the tick.
    pub has_entered: bool,
    /// The transitions that were taken.
    pub taken: &'t [TransitionId],
    /// The registers after the guards that were tried last.
    pub registers: &'t [f64],
}

/// The breakpoints during a run.
#[derive(Debug, Clone, Default)]
pub struct BreakpointWatch {
    /// For each breakpoint, the time (s) since which its condition holds.
    holding_since: Vec<Option<f64>>,
    /// True for each breakpoint that the tick before hit.
    were_hit: Vec<bool>,
}

impl BreakpointWatch {
    /// The first breakpoint that a tick hits. A condition that goes on holding hits once.
    pub fn hit<'b>(&mut self, policy: &'b Breakpoints, tick: &BreakpointTick<'_>) -> Option<&'b Breakpoint> {
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
    /// Those of [`explain`], with the source to which they belong. The source of an error in a condition is that condition, and the policy
    /// follows it as a part.
    pub fn new(source: &Source, texts: &[String]) -> Result<Self, (Source, Vec<Diagnostic>)> {
        let plain = explain(source).map_err(|faults| (source.clone(), faults))?;
        if let Some(empty) = texts.iter().find(|text| text.trim().is_empty()) {
            let span = Span::new(0, empty.len());
            let fault = Diagnostic::error("P0101", "a breakpoint is empty", span, "expected a state or a condition");
            let fault =
                fault.hint("write a state such as `Following`, or a condition such as `r0.base_angle > 300 urad`");
            return Err((Source::new("--break", empty.as_str()), vec![fault]));
        }
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
        let mut explained = explain(&whole).map_err(|faults| refused(&plain, source, &conditions, faults))?;
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

    /// Explains a policy and adds those of the breakpoints that it can have. The others are the second part of the result.
    ///
    /// # Errors
    /// Those of a policy that does not compile.
    pub fn possible(source: &Source, texts: &[String]) -> Result<(Self, Vec<String>), Vec<Diagnostic>> {
        if let Ok(policy) = Self::new(source, texts) {
            return Ok((policy, Vec::new()));
        }
        let is_possible = |text: &&String| Self::new(source, std::slice::from_ref(*text)).is_ok();
        let (possible, others): (Vec<&String>, Vec<&String>) = texts.iter().partition(is_possible);
        let possible: Vec<String> = possible.into_iter().cloned().collect();
        let policy = Self::new(source, &possible).map_err(|(_, faults)| faults)?;
        Ok((policy, others.into_iter().cloned().collect()))
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
        text.extend([BEFORE, condition, BEHIND]);
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

/// The text before a condition in the policy.
const BEFORE: &str = "\nalways when ";
/// The text after it.
const BEHIND: &str = " -> Failure(\"breakpoint\")";

/// The diagnostics of the first condition with an error, and their source. It shows the condition as it was written, because the policy
/// does not contain it.
fn refused(
    plain: &Explained,
    source: &Source,
    conditions: &[&String],
    faults: Vec<Diagnostic>,
) -> (Source, Vec<Diagnostic>) {
    let policy = source.part_span(0).end;
    let mut start = policy;
    let mut found = None;
    for &condition in conditions {
        let (first, last) = (start + BEFORE.len(), start + BEFORE.len() + condition.len());
        start = last + BEHIND.len();
        if found.is_none() && faults.iter().any(|fault| (policy..=start).contains(&fault.primary.span.start)) {
            found = Some((condition, first..last));
        }
    }
    let Some((condition, place)) = found else { return (with_conditions(source, conditions), faults) };
    let mut shown = Source::new("--break", condition.as_str());
    for part in 0..source.count() {
        let text = source
            .absence(part)
            .map_or_else(|| Ok(source.slice(source.part_span(part))), |absence| Err(absence.to_owned()));
        shown.add(source.part_name(part), text);
    }
    let is_unknown_name =
        faults.iter().any(|fault| fault.code == "P0201" && fault.primary.span.start == place.start + blanks(condition));
    if let Some(fault) = unknown(plain, condition, is_unknown_name) {
        return (shown, vec![fault]);
    }
    // The place in the condition, in the policy, or in a file that it uses.
    let added = start - policy;
    let moved = |span: Span| {
        let at = |byte: usize| match byte {
            _ if place.contains(&byte) || byte == place.end => byte - place.start,
            _ if byte <= policy => byte + condition.len() + 1,
            _ if byte >= start => byte - added + condition.len() + 1,
            _ => condition.len(),
        };
        Span::new(at(span.start), at(span.end).max(at(span.start)))
    };
    let is_own = |fault: &Diagnostic| (policy..=place.end + BEHIND.len()).contains(&fault.primary.span.start);
    let faults = faults.into_iter().filter(is_own).map(|mut fault| {
        for label in std::iter::once(&mut fault.primary).chain(&mut fault.secondary) {
            label.span = moved(label.span);
        }
        fault
    });
    (shown, faults.collect())
}

/// Number of blanks (bytes) before a text.
fn blanks(text: &str) -> usize {
    text.len() - text.trim_start().len()
}

/// The diagnostic for a text that can only be meant as a state or a transition, but is none: it has a colon, or begins with an unknown
/// name.
fn unknown(policy: &Explained, text: &str, is_unknown_name: bool) -> Option<Diagnostic> {
    let (name, guard) = text.split_once(':').map_or((text, None), |(name, guard)| (name, Some(guard)));
    let is_path =
        name.trim().split('.').all(|word| !word.is_empty() && word.chars().all(|c| c == '_' || c.is_alphanumeric()));
    if !is_path || !(is_unknown_name || guard.is_some()) {
        return None;
    }
    let (name, at) = (name.trim(), blanks(text));
    let span = Span::new(at, at + name.len());
    let states: Vec<&str> = policy.program.states.iter().map(|state| &*state.name).collect();
    if let Some(state) = states.iter().position(|state| *state == name) {
        let guards = policy.states.get(state)?.iter().map(|one| format!("`{}`", one.text)).collect::<Vec<_>>();
        let guard = guard?.trim();
        let message = format!("the state `{name}` has no transition with the guard `{guard}`");
        let fault = Diagnostic::error("P0201", message, Span::new(at, text.trim_end().len()), "unknown transition");
        return Some(fault.hint(if guards.is_empty() {
            "it has no transitions".to_owned()
        } else {
            format!("its guards are {}", guards.join(", "))
        }));
    }
    let fault =
        Diagnostic::error("P0201", format!("there is no state `{name}`"), span, "neither a state nor a condition");
    // The last name of a path may be that of a state in a behaviour.
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let meant = suggest(name, states.iter().copied()).map(str::to_owned).or_else(|| {
        let names: Vec<String> = states.iter().map(|state| last(state)).collect();
        let wanted = last(name);
        let near = suggest(&wanted, names.iter().map(String::as_str))?;
        states.iter().find(|state| last(state) == near).map(|state| (*state).to_owned())
    });
    Some(match meant {
        Some(meant) => fault.hint(format!("did you mean `{meant}`?")),
        None => fault.hint(format!(
            "the states are {}; a condition is such as `time > 5 s`",
            states.iter().map(|state| format!("`{state}`")).collect::<Vec<_>>().join(", ")
        )),
    })
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
