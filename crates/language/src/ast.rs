//! The syntax tree of a policy. Every node has its span in the source.

mod statement;

pub(super) use statement::{Binary, Expression, Kind, Statement, Steer, Turn};

use std::ops::Deref;
use std::sync::Arc;

use vibrissa_text::diagnostic::Span;

/// A name and its span.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) span: Span,
}

/// A file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct File {
    /// The name after `machine` or `library`. In a test file, the path of the machine's file.
    pub(super) name: Name,
    pub(super) kind: FileKind,
    /// True for a module of the standard library.
    pub(super) is_standard: bool,
    pub(super) uses: Vec<Use>,
    pub(super) whiskers: Vec<Name>,
    /// For each whisker, the contact estimator after `by`.
    pub(super) tip_models: Vec<Option<Name>>,
    /// For each whisker, true if it is optional: `if fitted`.
    pub(super) optional: Vec<bool>,
    pub(super) needs: Vec<Need>,
    /// `contour of … points … apart`: the keypoints of the whiskers' contours.
    pub(super) keypoints: Vec<Keypoints>,
    pub(super) contours: Vec<Contour>,
    pub(super) enumerations: Vec<Enumeration>,
    pub(super) compounds: Vec<Compound>,
    pub(super) parameters: Vec<Parameter>,
    pub(super) initial: Vec<Name>,
    pub(super) derived: Vec<Derived>,
    pub(super) laws: Vec<Law>,
    /// In the order of the text, so an outer state precedes its inner states.
    pub(super) states: Vec<State>,
    pub(super) behaviours: Vec<Behaviour>,
    pub(super) monitors: Vec<Monitor>,
    /// `var name = value` outside of all states
    pub(super) memory: Vec<(Name, Expression)>,
    /// Span of the first statement outside of all states.
    pub(super) acts: Option<Span>,
    /// The statements outside of all states. They are executed in every tick.
    pub(super) body: Vec<Statement>,
    pub(super) always: Vec<Transition>,
    /// `failsafe -> target`
    pub(super) failsafes: Vec<Target>,
    pub(super) contracts: Vec<Contract>,
    pub(super) tests: Vec<Test>,
}

/// What the first line of a file says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FileKind {
    Machine,
    Library,
    /// Tests of the machine in another file, which is the first of `uses`.
    Tests,
}

impl FileKind {
    /// The kind in messages.
    pub(super) fn phrase(self) -> &'static str {
        match self {
            Self::Machine => "a machine",
            Self::Library => "a library",
            Self::Tests => "a test file",
        }
    }
}

impl File {
    pub(super) fn is_library(&self) -> bool {
        self.kind == FileKind::Library
    }

    /// The names that another file can use: derived values, laws, behaviours, monitors and types.
    pub(super) fn exports(&self) -> impl Iterator<Item = &Name> {
        let derived = self.derived.iter().map(|item| &item.name);
        let laws = self.laws.iter().map(|item| &item.name);
        let enumerations = self.enumerations.iter().map(|item| &item.name);
        let monitors = self.monitors.iter().filter(|item| item.used.is_none()).map(|item| &item.name);
        let compounds = self.compounds.iter().map(|item| &item.name);
        let behaviours = self.behaviours.iter().map(|item| &item.name);
        derived.chain(laws).chain(behaviours).chain(monitors).chain(enumerations).chain(compounds)
    }
}

/// `use std.swipe`, `use "corner.fsm" (name, name)`
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Use {
    pub(super) from: From,
    /// Span of the file's name.
    pub(super) span: Span,
    /// The imported names. `None` if the whole file is imported.
    pub(super) names: Option<Vec<Name>>,
}

/// The file that a `use` names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum From {
    /// A module of the standard library: `std`, `swipe`.
    Module(Vec<Name>),
    /// A file by its path.
    Path(String),
}

/// `needs name in low .. high`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Need {
    pub(super) name: Name,
    pub(super) low: Bound,
    pub(super) high: Bound,
}

impl Need {
    /// Span of the range.
    pub(super) fn range(&self) -> Span {
        self.low.span.to(self.high.span)
    }
}

/// `contour name of count points spacing apart`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contour {
    pub(super) name: Name,
    pub(super) keypoints: Option<Keypoints>,
}

/// `of count points spacing apart`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Keypoints {
    /// The number of keypoints, as in the text.
    pub(super) count: Name,
    pub(super) spacing: Bound,
    pub(super) span: Span,
}

/// `type name = value or value`
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Enumeration {
    pub(super) name: Name,
    pub(super) values: Vec<Name>,
}

/// A type with several values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Compound {
    pub(super) name: Name,
    pub(super) content: Content,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Content {
    /// `type name(field: type)`
    Record(Vec<Argument>),
    /// `type name = list of most element`
    List {
        /// The maximum number of elements, as in the text.
        most: Name,
        element: TypeName,
    },
}

impl Compound {
    /// The names of the types of its parts.
    pub(super) fn types(&self) -> impl Iterator<Item = &TypeName> {
        let (fields, element) = match &self.content {
            Content::Record(fields) => (fields.as_slice(), None),
            Content::List { element, .. } => ([].as_slice(), Some(element)),
        };
        fields.iter().map(|field| &field.type_name).chain(element)
    }
}

/// `param name = value in low .. high`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: Name,
    pub(super) value: Setting,
    pub(super) range: Option<(Bound, Bound)>,
}

/// The value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Setting {
    Number(Bound),
    Bool(bool, Span),
    /// An enumeration and one of its values.
    Choice(Name, Name),
}

impl Setting {
    /// Span of the value.
    pub(super) fn span(&self) -> Span {
        match self {
            Self::Number(bound) => bound.span,
            Self::Bool(_, span) => *span,
            Self::Choice(of, value) => of.span.to(value.span),
        }
    }
}

/// A quantity with a sign.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bound {
    pub(super) negative: bool,
    pub(super) quantity: Quantity,
    pub(super) span: Span,
}

/// A number and its unit, as in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Quantity {
    pub(super) number: String,
    pub(super) unit: Option<Name>,
    pub(super) span: Span,
}

/// `name: type = default`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Argument {
    pub(super) name: Name,
    pub(super) type_name: TypeName,
    pub(super) default: Option<Expression>,
}

/// `length`, `vector of length`, `angular_speed / length`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TypeName {
    pub(super) base: Name,
    pub(super) of: Option<Name>,
    /// The factors after the first dimension, each with its operator: multiplication or division.
    pub(super) factors: Vec<(Binary, Name)>,
}

impl TypeName {
    /// Span of the whole name.
    pub(super) fn span(&self) -> Span {
        let others = self.of.iter().chain(self.factors.iter().map(|(_, factor)| factor));
        others.fold(self.base.span, |span, name| span.to(name.span))
    }
}

/// `let name(arguments) = value`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Derived {
    pub(super) name: Name,
    pub(super) arguments: Vec<Argument>,
    pub(super) value: Expression,
}

/// `law name(arguments) { … }`, or an event of a monitor with the same braces
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Law {
    pub(super) name: Name,
    pub(super) arguments: Vec<Argument>,
    pub(super) body: Vec<Statement>,
}

/// `state name(arguments) { … }`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    /// Index of the state that contains this one.
    pub(super) parent: Option<usize>,
    /// `initial Name(values)`. A state with inner states has exactly one.
    pub(super) initial: Vec<Arc<Step>>,
    pub(super) contracts: Arc<Vec<Contract>>,
    /// The use of a behaviour to which the state belongs: 0 for the states of the machine itself.
    pub(super) instance: usize,
    /// What all copies of the state have in common. A behaviour may be copied thousands of times.
    pub(super) content: Arc<StateContent>,
}

/// What all copies of a state have in common.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StateContent {
    pub(super) name: Name,
    pub(super) arguments: Vec<Argument>,
    /// `var name = value`
    pub(super) memory: Vec<(Name, Expression)>,
    pub(super) entry: Vec<Statement>,
    pub(super) exit: Vec<Statement>,
    pub(super) body: Vec<Statement>,
    pub(super) transitions: Vec<Transition>,
    pub(super) failsafes: Vec<Target>,
    /// `is name(values)`: the behaviour that is the content of the state.
    pub(super) behaviour: Option<Arc<Step>>,
    /// `on exit(names) -> target`
    pub(super) connections: Vec<Connection>,
    /// `exit name(arguments)`. Only the outermost state of a behaviour may have exits.
    pub(super) exits: Arc<Vec<Exit>>,
}

impl Deref for State {
    type Target = StateContent;

    fn deref(&self) -> &StateContent {
        &self.content
    }
}

/// `behaviour name(arguments) { … }`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Behaviour {
    pub(super) name: Name,
    /// Span of the whole declaration.
    pub(super) span: Span,
    /// The first one is the behaviour itself, with its name, arguments and exits. The others are inside it.
    pub(super) states: Vec<State>,
}

impl Behaviour {
    /// The behaviour itself as a state.
    pub(super) fn root(&self) -> &State {
        &self.states[0]
    }
}

/// `monitor name(arguments) { … }`, `monitor name is other(values)`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Monitor {
    pub(super) name: Name,
    pub(super) arguments: Vec<Argument>,
    /// `var name = value`
    pub(super) memory: Vec<(Name, Expression)>,
    pub(super) body: Vec<Statement>,
    /// `on name(arguments) { … }`
    pub(super) events: Vec<Law>,
    /// The monitor after `is`, with the values of its arguments.
    pub(super) used: Option<Step>,
}

/// `exit name(arguments)`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Exit {
    pub(super) name: Name,
    pub(super) arguments: Vec<Argument>,
}

/// `on exit(names) -> target`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Connection {
    pub(super) exit: Name,
    /// The names of the exit's values.
    pub(super) names: Vec<Name>,
    pub(super) target: Target,
}

/// `when …` and `after …`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Transition {
    pub(super) guard: Guard,
    pub(super) target: Target,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Guard {
    When { condition: Expression, lasting: Option<Expression> },
    After(Expression),
}

impl Guard {
    /// Span of the condition or the time, without the time of `for`.
    pub(super) fn span(&self) -> Span {
        match self {
            Self::When { condition, .. } => condition.span,
            Self::After(time) => time.span,
        }
    }
}

/// `assume condition`, `never condition for time`, `always condition within time`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contract {
    pub(super) kind: ContractKind,
    pub(super) condition: Expression,
    /// The time after `for` or `within`.
    pub(super) time: Option<Expression>,
    pub(super) span: Span,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ContractKind {
    Assume,
    Never,
    Always,
}

/// `Name(values)`: a state and the values of its arguments.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    pub(super) name: Name,
    pub(super) values: Vec<Expression>,
    pub(super) span: Span,
}

/// `Name`, `Name(values)`, `Outer(values).Name(values)`, `resume Name(values)`, `Failure("reason")`, `exit name(values)`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Target {
    /// True for an exit of the behaviour.
    pub(super) is_exit: bool,
    /// Span of `resume`, which enters the inner state that was active last (history).
    pub(super) resume: Option<Span>,
    /// The outer states before the state.
    pub(super) outer: Vec<Step>,
    pub(super) name: Name,
    pub(super) text: Option<Name>,
    pub(super) values: Vec<Expression>,
    pub(super) span: Span,
}

/// `test "title" in "scenario" { set name = value  expect truth }`, or a property with the same braces
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Test {
    pub(super) title: Name,
    pub(super) scenes: TestScenes,
    pub(super) settings: Vec<(Name, Setting)>,
    pub(super) expectations: Vec<Expression>,
}

/// The scenes of a test.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TestScenes {
    /// `in "scenario"`
    Scenario(Name),
    /// `over family(ranges)`
    Family { family: Name, ranges: Vec<Range> },
}

/// `name in low .. high`, `name = value`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Range {
    pub(super) name: Name,
    pub(super) low: Bound,
    /// `None` for one value.
    pub(super) high: Option<Bound>,
}
