//! Positions of a policy's states and transitions in its text.

use serde::{Deserialize, Serialize};

use super::program::Program;

/// A position in a text. Lines and columns count from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Position {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1, in characters.
    pub column: usize,
}

/// Positions of a policy's states and transitions in its text, in the program's order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceMap {
    /// Conditions of the global transitions.
    pub always: Vec<Position>,
    /// The states.
    pub states: Vec<StatePosition>,
}

/// Positions of a state and its transitions.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StatePosition {
    /// Position of the name.
    pub name: Position,
    /// Positions of the conditions of its transitions.
    pub transitions: Vec<Position>,
}

impl SourceMap {
    /// True if there is exactly one position for every state and transition of `program`.
    pub(super) fn fits(&self, program: &Program) -> bool {
        let counts =
            |(position, state): (&StatePosition, &super::State)| position.transitions.len() == state.transitions.len();
        self.always.len() == program.always.len()
            && self.states.len() == program.states.len()
            && self.states.iter().zip(&program.states).all(counts)
    }
}
