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
    /// The conditions of the transitions that are tried whatever the state.
    pub always: Vec<Position>,
    /// The states.
    pub states: Vec<StatePosition>,
}

/// Where in its text a state is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StatePosition {
    /// Its name.
    pub name: Position,
    /// The conditions of its transitions.
    pub transitions: Vec<Position>,
}

impl SourceMap {
    /// Whether there is a place for every state and every transition of `program`, and no other.
    pub(super) fn fits(&self, program: &Program) -> bool {
        let counts =
            |(position, state): (&StatePosition, &super::State)| position.transitions.len() == state.transitions.len();
        self.always.len() == program.always.len()
            && self.states.len() == program.states.len()
            && self.states.iter().zip(&program.states).all(counts)
    }
}
