//! The numbers of guards in messages.

use vibrissa_runtime::machine::TransitionId;

use crate::inspect::{Breakpoint, Breakpoints};

/// Gives each guard of a policy a number: global ones first, then those of every state. Guards of breakpoints have none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GuardNumbers {
    /// Number of global transitions.
    always: usize,
    /// For each state, the number of its first guard, and the number of its guards.
    states: Vec<(usize, usize)>,
}

impl GuardNumbers {
    /// The numbers for a policy.
    #[must_use]
    pub fn new(policy: &Breakpoints) -> Self {
        // The conditions of breakpoints are global guards after those of the policy.
        let is_condition = |breakpoint: &&Breakpoint| breakpoint.state().is_none() && breakpoint.transition().is_none();
        let conditions = policy.breakpoints.iter().filter(is_condition).count();
        let always = policy.explained.always.len().saturating_sub(conditions);
        let mut next = always;
        let states = policy.explained.states.iter().map(|guards| {
            let first = next;
            next += guards.len();
            (first, guards.len())
        });
        Self { states: states.collect(), always }
    }

    /// All transitions, in the order of their numbers.
    pub fn transitions(&self) -> impl Iterator<Item = TransitionId> {
        let of_states =
            self.states.iter().enumerate().flat_map(|(state, &(_, count))| {
                (0..count).map(move |index| TransitionId { state: Some(state), index })
            });
        (0..self.always).map(|index| TransitionId { state: None, index }).chain(of_states)
    }

    /// The number of a guard.
    #[must_use]
    pub fn number(&self, id: TransitionId) -> Option<usize> {
        match id.state {
            None => (id.index < self.always).then_some(id.index),
            Some(state) => {
                let &(first, count) = self.states.get(state)?;
                (id.index < count).then_some(first + id.index)
            }
        }
    }
}
