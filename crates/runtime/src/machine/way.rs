//! The way from an outermost state to one that lies in it.

use super::program::{NESTING_LIMIT, Program};

/// The states that are active with one of them, the outermost first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    states: [usize; NESTING_LIMIT],
    count: usize,
}

impl Way {
    /// The way to a state. States nest [`NESTING_LIMIT`] deep at most.
    pub(super) fn to(program: &Program, innermost: usize) -> Self {
        let mut way = Self { states: [innermost; NESTING_LIMIT], count: 0 };
        for (place, state) in way.states.iter_mut().zip(program.outward(innermost)) {
            *place = state;
            way.count += 1;
        }
        way.states[..way.count].reverse();
        way
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
