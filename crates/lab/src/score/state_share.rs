//! The time shares of the states of a policy.

use crate::run::Trace;

/// The time share of a state.
#[derive(Debug, Clone, PartialEq)]
pub struct StateShare {
    /// Name of the state, `Failure` for the time after a failure.
    pub state: String,
    /// Its share of the run's ticks, 0 to 1.
    pub share: f64,
}

/// The shares of all active states, in the order of the machine. Of nested states the innermost counts, so that the
/// shares sum to 1. Empty without ticks.
#[must_use]
pub fn state_shares(trace: &Trace) -> Vec<StateShare> {
    // An index without a state represents the failure, after all states.
    let failure = trace.states.len();
    let mut ticks = vec![0_usize; failure + 1];
    for tick in &trace.ticks {
        ticks[tick.state.unwrap_or(failure).min(failure)] += 1;
    }
    let names = trace.states.iter().map(String::as_str).chain(["Failure"]);
    let active = names.zip(ticks).filter(|&(_, ticks)| ticks > 0);
    let share = |ticks| ticks as f64 / trace.ticks.len() as f64;
    active.map(|(state, ticks)| StateShare { state: state.to_owned(), share: share(ticks) }).collect()
}
