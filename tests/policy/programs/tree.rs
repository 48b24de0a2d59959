//! Programs as trees.

use super::statement::Statement;

/// The types that the programs have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    Number,
    Length,
    Angle,
    Time,
    Speed,
    Rate,
    Frequency,
    Truth,
    Vector,
    Direction,
    /// A displacement.
    Shift,
    Place,
    Whisker,
    Contour,
    /// The enumeration that every program has.
    Choice,
    /// The record that every program has: a number, a position and a truth.
    Record,
    /// The list that every program has: up to [`LIST_LENGTH`] positions.
    List,
}

/// The maximum length of the list.
pub(crate) const LIST_LENGTH: usize = 3;

impl Type {
    pub(crate) const ALL: [Self; 17] = [
        Self::Number,
        Self::Truth,
        Self::Vector,
        Self::Direction,
        Self::Whisker,
        Self::Speed,
        Self::Length,
        Self::Angle,
        Self::Time,
        Self::Rate,
        Self::Frequency,
        Self::Place,
        Self::Shift,
        Self::Contour,
        Self::Choice,
        Self::Record,
        Self::List,
    ];
}

#[derive(Debug, Clone)]
pub(crate) enum Expression {
    /// A number as it is written, and its unit.
    Quantity(&'static str, &'static str),
    Truth(bool),
    /// A value of the enumeration.
    Choice(usize),
    Name(String),
    /// A function or a derived value. Every use has a number of its own, for what it remembers.
    Call(String, Vec<Expression>, usize),
    Body(&'static str),
    /// A member of the map, with all names before it, and its values.
    Map(&'static str, Vec<Expression>),
    Member(Box<Expression>, &'static str, Vec<Expression>),
    /// The value of a call for the argument with this name.
    Named(String, Box<Expression>),
    /// The default of an argument that a call leaves out.
    Omitted(Box<Expression>),
    Norm(Box<Expression>),
    Negate(Box<Expression>),
    Not(Box<Expression>),
    /// A condition, and the values if it holds and if not.
    If(Box<[Expression; 3]>),
    Binary(&'static str, Box<Expression>, Box<Expression>),
}

/// Some have a [default](default).
pub(crate) type Arguments = Vec<(String, Type)>;

/// The default of an argument. Its name says whether it has one.
pub(crate) fn default(name: &str, r#type: Type) -> Option<Expression> {
    let number: usize = name[1..].parse().unwrap();
    let quantity = |number, unit| Some(Expression::Quantity(number, unit));
    match r#type {
        _ if !number.is_multiple_of(2) => None,
        Type::Number => quantity("2", ""),
        Type::Length => quantity("3.7", "mm"),
        Type::Time => quantity("100", "ms"),
        Type::Speed => quantity("10", "mm/s"),
        Type::Truth => Some(Expression::Truth(true)),
        Type::Choice => Some(Expression::Choice(1)),
        Type::Whisker => Some(Expression::Name("w0".to_owned())),
        _ => None,
    }
}

/// A derived value.
#[derive(Debug, Clone)]
pub(crate) struct Derived {
    pub(crate) name: String,
    pub(crate) arguments: Arguments,
    pub(crate) r#type: Type,
    pub(crate) value: Expression,
}

#[derive(Debug, Clone)]
pub(crate) struct Law {
    pub(crate) name: String,
    pub(crate) arguments: Arguments,
    pub(crate) commands: bool,
    pub(crate) body: Vec<Statement>,
}

#[derive(Debug, Clone)]
pub(crate) enum Guard {
    When(Expression),
    WhenFor(Expression, Expression),
    After(Expression),
}

#[derive(Debug, Clone)]
pub(crate) enum Target {
    Failure(String),
    Success(String),
    /// The states that are entered on the way, with their values; the last is where it leads.
    State {
        way: Vec<(usize, Vec<Expression>)>,
        resume: bool,
    },
}

#[derive(Debug, Clone)]
pub(crate) struct Rule {
    pub(crate) guard: Guard,
    pub(crate) target: Target,
}

#[derive(Debug, Clone)]
pub(crate) enum Contract {
    Assume(Expression),
    Never(Expression, Option<Expression>),
    /// A condition, and the time within which it holds again.
    Always(Expression, Expression),
}

#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    pub(crate) parent: Option<usize>,
    pub(crate) arguments: Arguments,
    pub(crate) memory: Vec<(String, Type, Expression)>,
    pub(crate) initial: Option<(usize, Vec<Expression>)>,
    pub(crate) entry: Vec<Statement>,
    pub(crate) exit: Vec<Statement>,
    pub(crate) body: Vec<Statement>,
    pub(crate) rules: Vec<Rule>,
    pub(crate) failsafe: Option<Target>,
    pub(crate) contracts: Vec<Contract>,
}

/// A monitor, and the values of its arguments where it is used.
#[derive(Debug, Clone)]
pub(crate) struct Monitor {
    pub(crate) arguments: Arguments,
    pub(crate) values: Vec<Expression>,
    pub(crate) memory: Vec<(String, Type, Expression)>,
    pub(crate) body: Vec<Statement>,
    /// Its event, `e`.
    pub(crate) event: (Arguments, Vec<Statement>),
}

#[derive(Clone, Default)]
pub(crate) struct Program {
    pub(crate) whiskers: usize,
    pub(crate) contours: usize,
    /// Names and quantities.
    pub(crate) parameters: Vec<(String, Expression)>,
    pub(crate) derived: Vec<Derived>,
    pub(crate) laws: Vec<Law>,
    /// Elsewhere, `M0.k` is what `k` is in the first of them.
    pub(crate) monitors: Vec<Monitor>,
    /// What the machine itself remembers, and what it does every tick; a `let` stands only in the blocks of an `if`.
    pub(crate) memory: Vec<(String, Type, Expression)>,
    pub(crate) body: Vec<Statement>,
    /// An outer state comes before those in it; the machine begins in the first.
    pub(crate) states: Vec<State>,
    pub(crate) always: Vec<Rule>,
    pub(crate) failsafe: Option<Target>,
    pub(crate) contracts: Vec<Contract>,
}

impl Program {
    /// From the outermost state to `state`.
    pub(crate) fn way(&self, state: usize) -> Vec<usize> {
        let mut way: Vec<usize> = std::iter::successors(Some(state), |&state| self.states[state].parent).collect();
        way.reverse();
        way
    }

    /// The states on the way to a target that it enters, if it is of a rule of `from`.
    pub(crate) fn entered(&self, from: Option<usize>, target: usize) -> Vec<usize> {
        let (from, way) = (from.map_or_else(Vec::new, |from| self.way(from)), self.way(target));
        let outer = &way[..way.len() - 1];
        let stay = outer.iter().zip(&from).take_while(|(outer, from)| outer == from).count();
        way[stay..].to_vec()
    }
}
