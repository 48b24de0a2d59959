//! Declared names and their uses.

use crate::builtins::Member;
use crate::types::Type;
use vibrissa_declare::catalogue::{Entry, Parameter};
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Span;

/// The kind of a declared name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymbolKind {
    /// The machine or the library itself.
    Machine,
    /// A whisker of the rig.
    Whisker,
    /// A contour of positions.
    Contour,
    /// A parameter.
    Parameter,
    /// An enumeration.
    Enumeration,
    /// A value of an enumeration.
    Choice,
    /// A record or a list.
    Compound,
    /// A field of a record.
    Field,
    /// A derived value.
    Derived,
    /// A law.
    Law,
    /// A state.
    State,
    /// A behaviour.
    Behaviour,
    /// A monitor.
    Monitor,
    /// An exit of a behaviour.
    Exit,
    /// An event of a monitor.
    Event,
    /// An argument of a law, a derived value or a state.
    Argument,
    /// A named value of a statement.
    Local,
    /// Memory of a state or of the machine, kept from tick to tick.
    Memory,
}

impl SymbolKind {
    /// True if the whole policy knows the name.
    pub(super) fn is_item(self) -> bool {
        !matches!(
            self,
            Self::Argument | Self::Local | Self::Memory | Self::Choice | Self::Field | Self::Exit | Self::Event
        )
    }

    /// True if the name means a value.
    pub(super) fn is_value(self) -> bool {
        !matches!(
            self,
            Self::Machine
                | Self::Law
                | Self::State
                | Self::Enumeration
                | Self::Choice
                | Self::Compound
                | Self::Field
                | Self::Behaviour
                | Self::Exit
                | Self::Event
        )
    }
}

/// A declared name.
#[derive(Debug, Clone, PartialEq)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// The kind.
    pub kind: SymbolKind,
    /// Span of the name in its declaration, which may be in another part of the source.
    pub span: Span,
    /// Span of the whole declaration: an item, a statement, or an argument with its type.
    pub whole: Span,
    /// The names of the arguments.
    pub arguments: Vec<String>,
    /// The symbol whose braces or parentheses contain this one.
    pub owner: Option<usize>,
    /// The span in which the name is visible.
    pub(super) visible: Span,
    pub(super) r#type: Option<Type>,
}

/// The effect of a use of a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The use declares the name.
    Declares,
    /// The use changes the memory.
    Writes,
    /// Any other use.
    Reads,
}

/// The meaning of a word in the text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    Symbol(usize, Role),
    /// A built-in function, by its index in the table.
    Function(usize),
    Member(Type, Member),
    /// A member of a list, by the symbol of its type and its index in the table.
    ListMember(usize, usize),
    /// An event of the map, by its index in the table.
    MapEvent(usize),
    Type(Type),
    Unit(Dimension),
    /// A used file, by its part of the source.
    File(usize),
    /// A keyword.
    Keyword(&'static str),
    /// A family of scenes.
    Family(&'static Entry),
    /// A parameter of a family of scenes.
    FamilyParameter(&'static Parameter),
    Unknown,
}

/// A word in the text with its meaning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Use {
    pub(super) span: Span,
    pub(super) meaning: Meaning,
}
