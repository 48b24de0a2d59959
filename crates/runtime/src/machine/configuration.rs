//! The way from an outermost state to one that lies in it.

use super::program::{NESTING_LIMIT, Program};

/// The states that are active with one of them, the outermost first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Configuration {
    states: [usize; NESTING_LIMIT],
    count: usize,
}

impl Configuration {
    /// The way to a state. States nest [`NESTING_LIMIT`] deep at most.
    pub(super) fn to(program: &Program, innermost: usize) -> Self {
        let mut configuration = Self { states: [innermost; NESTING_LIMIT], count: 0 };
        for (slot, state) in configuration.states.iter_mut().zip(program.outward(innermost)) {
            *slot = state;
            configuration.count += 1;
        }
        configuration.states[..configuration.count].reverse();
        configuration
    }

    /// From the outermost to the innermost.
    #[inline]
    pub(super) fn states(&self) -> &[usize] {
        &self.states[..self.count]
    }

    /// The state that it leads to.
    #[inline]
    pub(super) fn innermost(&self) -> usize {
        self.states[self.count - 1]
    }
}
