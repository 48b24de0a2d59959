//! The active configuration of a machine.

use super::program::{NESTING_LIMIT, Program};

/// The active configuration: an innermost state and all its outer states, the outermost first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Configuration {
    /// States in the first `count` entries, the outermost first.
    states: [usize; NESTING_LIMIT],
    count: usize,
}

impl Configuration {
    /// The configuration in which `innermost` is the innermost state. States are nested at most [`NESTING_LIMIT`] deep.
    pub(super) fn to(program: &Program, innermost: usize) -> Self {
        let mut configuration = Self { states: [innermost; NESTING_LIMIT], count: 0 };
        for (slot, state) in configuration.states.iter_mut().zip(program.outward(innermost)) {
            *slot = state;
            configuration.count += 1;
        }
        configuration.states[..configuration.count].reverse();
        configuration
    }

    /// The active states, from the outermost to the innermost.
    #[inline]
    pub(super) fn states(&self) -> &[usize] {
        &self.states[..self.count]
    }

    /// Index of the innermost active state.
    #[inline]
    pub(super) fn innermost(&self) -> usize {
        self.states[self.count - 1]
    }
}
