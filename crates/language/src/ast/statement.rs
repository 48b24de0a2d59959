//! Statements and expressions.

use vibrissa_text::diagnostic::Span;

use super::{Name, Quantity};

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Statement {
    Let {
        name: Name,
        value: Expression,
    },
    /// `set name = value`
    Set {
        name: Name,
        value: Expression,
    },
    /// Conditions with their blocks, in the order of evaluation, and the `else` block.
    If {
        branches: Vec<(Expression, Vec<Statement>)>,
        otherwise: Vec<Statement>,
    },
    Do {
        law: Name,
        values: Vec<Expression>,
        span: Span,
    },
    Record(Expression),
    /// `record position in contour`
    RecordPosition {
        position: Expression,
        contour: Name,
    },
    /// `mark name whisker`
    Mark {
        name: Name,
        whisker: Expression,
    },
    Steer(Box<Steer>),
    /// `tell monitor.event(values)`
    Tell {
        monitor: Name,
        event: Name,
        values: Vec<Expression>,
        span: Span,
    },
    /// `plot name = value`
    Plot {
        name: Name,
        value: Expression,
    },
    /// `log "text", values`
    Log {
        text: Name,
        values: Vec<Expression>,
        span: Span,
    },
    Hold(Span),
    Stop(Span),
}

impl Statement {
    /// The expressions of the statement, without those of its blocks.
    pub(crate) fn expressions(&self) -> Vec<&Expression> {
        match self {
            Self::Let { value, .. }
            | Self::Set { value, .. }
            | Self::Plot { value, .. }
            | Self::Record(value)
            | Self::RecordPosition { position: value, .. }
            | Self::Mark { whisker: value, .. } => vec![value],
            Self::If { branches, .. } => branches.iter().map(|(condition, _)| condition).collect(),
            Self::Do { values, .. } | Self::Tell { values, .. } | Self::Log { values, .. } => values.iter().collect(),
            Self::Steer(steer) => {
                let (Turn::Facing(turn) | Turn::Turning(turn)) = &steer.turn;
                steer.whisker.iter().chain([&steer.along, &steer.speed, turn]).collect()
            }
            Self::Hold(_) | Self::Stop(_) => Vec::new(),
        }
    }

    /// The blocks of the statement.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = &[Statement]> {
        let (branches, otherwise) = match self {
            Self::If { branches, otherwise } => (branches.as_slice(), otherwise.as_slice()),
            _ => Default::default(),
        };
        branches.iter().map(|(_, block)| block.as_slice()).chain([otherwise])
    }

    /// The law or the monitor that the statement uses. A contour that is only recorded is not used.
    pub(crate) fn used(&self) -> Option<&Name> {
        match self {
            Self::Do { law: used, .. } | Self::Tell { monitor: used, .. } => Some(used),
            _ => None,
        }
    }
}

/// `steer mover along direction at speed facing angle`
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Steer {
    /// The whisker whose base moves. `None` for the body.
    pub(crate) whisker: Option<Expression>,
    pub(crate) along: Expression,
    pub(crate) speed: Expression,
    pub(crate) turn: Turn,
    pub(crate) span: Span,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Turn {
    Facing(Expression),
    Turning(Expression),
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Expression {
    pub(crate) kind: Kind,
    pub(crate) span: Span,
    /// Levels of nesting below this node. The parser bounds them.
    pub(crate) depth: usize,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    Quantity(Quantity),
    Bool(bool),
    /// `name`, `name(values)`, `body`
    Root {
        name: Name,
        values: Option<Vec<Expression>>,
    },
    /// `owner.name`, `owner.name(values)`
    Member {
        owner: Box<Expression>,
        name: Name,
        values: Option<Vec<Expression>>,
    },
    Norm(Box<Expression>),
    Negate(Box<Expression>),
    Not(Box<Expression>),
    /// `name: value`, only among the values of a call.
    Named {
        name: Name,
        value: Box<Expression>,
    },
    /// `if condition then value else otherwise`
    If {
        condition: Box<Expression>,
        value: Box<Expression>,
        otherwise: Box<Expression>,
    },
    Binary {
        operator: Binary,
        left: Box<Expression>,
        right: Box<Expression>,
    },
}

vibrissa_runtime::kinds! {
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum Binary,
    /// The text of the operator.
    fn symbol {
        Or = "or",
        And = "and",
        Less = "<",
        LessOrEqual = "<=",
        Greater = ">",
        GreaterOrEqual = ">=",
        Equal = "==",
        Unequal = "!=",
        Add = "+",
        Subtract = "-",
        Multiply = "*",
        Divide = "/",
    }
}
