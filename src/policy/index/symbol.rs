//! Names that a policy gives, and where they are used.

use crate::diagnostic::Span;
use crate::policy::builtins::Member;
use crate::policy::types::Type;
use vibrissa_runtime::units::Dimension;

/// What a name that a policy gives stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymbolKind {
    /// The machine or the library itself.
    Machine,
    /// A whisker of the rig.
    Whisker,
    /// A parameter.
    Parameter,
    /// A derived value.
    Derived,
    /// A law.
    Law,
    /// A state.
    State,
    /// An argument of a law, a derived value or a state.
    Argument,
    /// A value that a statement names.
    Local,
    /// What a state, or the machine, keeps from tick to tick.
    Memory,
}

impl SymbolKind {
    /// Whether the whole policy knows the name.
    pub(super) fn is_item(self) -> bool {
        !matches!(self, Self::Argument | Self::Local | Self::Memory)
    }

    /// Whether the name stands for a value.
    pub(super) fn is_value(self) -> bool {
        !matches!(self, Self::Machine | Self::Law | Self::State)
    }
}

/// A name that a policy gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// What it stands for.
    pub kind: SymbolKind,
    /// Where it is given, maybe in another part of the source.
    pub span: Span,
    /// All that gives it its meaning: an item, a statement, an argument with its type.
    pub whole: Span,
    /// The names of its arguments.
    pub arguments: Vec<String>,
    /// The symbol in whose braces or parentheses it stands.
    pub owner: Option<usize>,
    /// Where it is known.
    pub(super) visible: Span,
    pub(super) r#type: Option<Type>,
}

/// What a use of a name does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Gives the name its meaning.
    Declares,
    /// Changes the memory that the name stands for.
    Writes,
    /// Anything else.
    Reads,
}

/// What a word in the text means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    Symbol(usize, Role),
    /// A function of the language, by its place in the table.
    Function(usize),
    Member(Type, Member),
    Type(Type),
    Unit(Dimension),
    /// A file that is used, by its part of the source.
    File(usize),
    /// A word of the language.
    Word(&'static str),
    Unknown,
}

/// A word in the text, and what it means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Use {
    pub(super) span: Span,
    pub(super) meaning: Meaning,
}
