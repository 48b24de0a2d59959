use super::position::Position;
use crate::index::Expected;

/// The role of a word, which editors show by its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    /// It begins a declaration.
    Declaration,
    /// It begins or joins a part of the control flow.
    Control,
    /// It belongs to a command or another action.
    Action,
    /// It joins values.
    Operator,
    /// It is a value that never changes.
    Constant,
    /// It is another value.
    Variable,
}

/// The grammatical properties of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Class {
    pub(super) role: Role,
    pub(super) positions: &'static [Position],
    /// What follows the word. `None` if the word may end a statement.
    pub(super) next: Option<Expected>,
}

impl Class {
    pub(crate) const fn new(role: Role, positions: &'static [Position], next: Expected) -> Self {
        Self { role, positions, next: Some(next) }
    }

    /// The class of a word that is followed by `next`.
    pub(crate) const fn before(self, next: Expected) -> Self {
        Self { next: Some(next), ..self }
    }

    /// The class of a word that may end a statement.
    pub(crate) const fn complete(self) -> Self {
        Self { next: None, ..self }
    }
}
