//! Statements as trees and as texts.

use super::text::{call, list};
use super::tree::{Expression, Type};

#[derive(Debug, Clone)]
pub(crate) enum Statement {
    Let(String, Expression),
    Set(String, Expression),
    If(Vec<(Expression, Vec<Statement>)>, Vec<Statement>),
    /// A law, the values that it is given, and the number of this use.
    Do(String, Vec<Expression>, usize),
    /// A monitor, the values that its event is given, and the number of this use.
    Tell(usize, Vec<Expression>, usize),
    /// Something that the map is told, and its values.
    TellMap(&'static str, Vec<Expression>),
    Record(Expression),
    /// A position, and the number of the contour that gets it.
    RecordPosition(Expression, usize),
    Mark(&'static str, Expression),
    /// The type of the value, which the plot's name has, and the value.
    Plot(Type, Expression),
    /// The number of this message, and its values.
    Log(usize, Vec<Expression>),
    Steer(Steer),
    Hold,
    Stop,
}

#[derive(Debug, Clone)]
pub(crate) struct Steer {
    pub(crate) whisker: Option<Expression>,
    pub(crate) along: Expression,
    pub(crate) speed: Expression,
    /// Whether `turn` is a heading, not a rate.
    pub(crate) facing: bool,
    pub(crate) turn: Expression,
}

pub(super) fn block(statements: &[Statement]) -> String {
    statements.iter().map(|statement| statement.text() + "\n").collect()
}

impl Statement {
    fn text(&self) -> String {
        match self {
            Self::Let(name, value) => format!("let {name} = {}", value.text()),
            Self::Set(name, value) => format!("set {name} = {}", value.text()),
            Self::If(branches, otherwise) => {
                let branch = |(condition, then): &(Expression, Vec<Statement>)| {
                    format!("if {} {{\n{}}}", condition.text(), block(then))
                };
                let branches: Vec<String> = branches.iter().map(branch).collect();
                let otherwise =
                    if otherwise.is_empty() { String::new() } else { format!(" else {{\n{}}}", block(otherwise)) };
                branches.join(" else ") + &otherwise
            }
            Self::Do(law, values, _) => format!("do {law}({})", list(values)),
            Self::Tell(monitor, values, _) => format!("tell {}", call(&format!("M{monitor}.e"), values)),
            Self::TellMap(event, values) if values.is_empty() => format!("tell map.{event}"),
            Self::TellMap(event, values) => format!("tell map.{}", call(event, values)),
            Self::RecordPosition(position, contour) => format!("record {} in c{contour}", position.text()),
            Self::Record(whisker) => format!("record {}", whisker.text()),
            Self::Plot(of, value) => format!("plot {} = {}", plot_name(*of), value.text()),
            Self::Log(message, values) => {
                let values: Vec<String> = values.iter().map(|value| format!(", {}", value.text())).collect();
                format!("log \"m{message}\"{}", values.concat())
            }
            Self::Mark(mark, whisker) => format!("mark {mark} {}", whisker.text()),
            Self::Steer(Steer { whisker, along, speed, facing, turn }) => {
                let mover = whisker.as_ref().map_or_else(|| "body".to_owned(), Expression::text);
                let (along, speed, turn) = (along.text(), speed.text(), turn.text());
                format!("steer {mover} along {along} at {speed} {} {turn}", if *facing { "facing" } else { "turning" })
            }
            Self::Hold => "hold".to_owned(),
            Self::Stop => "stop".to_owned(),
        }
    }
}

/// The name of the plot of values of a type.
pub(crate) fn plot_name(of: Type) -> String {
    format!("p{of:?}")
}
