//! What a policy shows of itself: the values of its `plot` statements and the messages of its `log` statements.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::geometry::Vector2;
use crate::units::{Dimension, format_si};

use super::op::Register;
use super::parameter::DESCRIPTION_LIMIT;
use super::unsound::Unsound;
use super::verify::{distinct, is_name, within};

/// Maximum number of plots of a program.
pub const PLOT_LIMIT: usize = 32;
/// Maximum number of messages of a program. A message of a behaviour counts for each state that uses the behaviour.
pub const MESSAGE_LIMIT: usize = 1_000;
/// Maximum number of numbers in a message. A vector has two.
pub const NUMBERS_LIMIT: usize = 8;

/// The plots and messages of a program.
///
/// They have no effect on the machine. Their statements count in the register `counter`, and store the count in the register
/// `number` of the plot or message. So a message belongs to the newest tick if its number exceeds the count at the start
/// of that tick, and the numbers tell the order of messages.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Outputs {
    /// Register of the count. It is 0 without plots and messages.
    pub counter: Register,
    /// The plots.
    pub plots: Vec<Plot>,
    /// The messages.
    pub messages: Vec<Message>,
}

/// A value over time with a name. Several statements may set it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// Its name, unique among the plots.
    pub name: String,
    /// The kind of its values. It is neither a vector nor a whisker.
    pub kind: OutputKind,
    /// Register of the value.
    pub value: Register,
    /// Register of its number, as described at [`Outputs`].
    pub number: Register,
}

/// A message with the values that it shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Message {
    /// Index of the state that contains the statement. `None` outside of states.
    pub state: Option<usize>,
    /// The text.
    pub text: Arc<str>,
    /// The values. They have at most [`NUMBERS_LIMIT`] numbers.
    pub values: Vec<MessageValue>,
    /// Register of its number, as described at [`Outputs`].
    pub number: Register,
}

/// A value of a message.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MessageValue {
    /// The expression as in the policy, on one line.
    pub name: Arc<str>,
    /// The kind of the value.
    pub kind: OutputKind,
    /// Register of the value, and the first of two for a vector.
    pub value: Register,
}

/// The kind of a value that a policy shows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum OutputKind {
    /// A number with this dimension.
    Number(Dimension),
    /// A bool.
    Truth,
    /// One of these names, as its index.
    Choice(Vec<String>),
    /// A vector with this dimension.
    Vector(Dimension),
    /// A whisker, as its index among those of the program.
    Whisker,
}

/// A value that a policy shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Shown {
    /// A number (SI) and its dimension.
    Number(f64, Dimension),
    /// A bool.
    Truth(bool),
    /// A value of an enumeration, or the name of a whisker.
    Name(String),
    /// A vector (SI) and its dimension.
    Vector(Vector2, Dimension),
}

/// The value with its unit, as in `12.5 mm`.
impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value, dimension) => f.write_str(&format_si(*value, *dimension)),
            Self::Truth(truth) => write!(f, "{truth}"),
            Self::Name(name) => f.write_str(name),
            Self::Vector(vector, dimension) => {
                write!(f, "({}, {})", format_si(vector.x, *dimension), format_si(vector.y, *dimension))
            }
        }
    }
}

impl Outputs {
    /// The number of executed statements, from the registers of a machine.
    pub(super) fn count(&self, registers: &[f64]) -> f64 {
        registers.get(usize::from(self.counter)).copied().unwrap_or_default()
    }

    /// The plots with a number above `before`, by their index, with their values.
    pub(super) fn plotted(&self, registers: &[f64], before: f64) -> impl Iterator<Item = (usize, f64)> {
        let plots = self.plots.iter().enumerate();
        let new = plots.filter(move |(_, plot)| registers[usize::from(plot.number)] > before);
        new.map(|(index, plot)| (index, registers[usize::from(plot.value)]))
    }

    /// The messages with a number above `before`, in the order of their numbers. A message that was logged several times has
    /// its last values and its last place.
    pub(super) fn logged(&self, registers: &[f64], before: f64) -> impl Iterator<Item = LoggedMessage> {
        let (mut last, newest) = (before, self.count(registers));
        std::iter::from_fn(move || {
            if last >= newest {
                return None;
            }
            let messages = self.messages.iter().enumerate();
            let numbered = messages.map(|(index, message)| (registers[usize::from(message.number)], index, message));
            let next = numbered.filter(|(number, ..)| *number > last).min_by(|a, b| a.0.total_cmp(&b.0));
            let (number, message, content) = next?;
            last = number;
            Some(LoggedMessage { message, numbers: content.numbers(registers) })
        })
    }

    /// Checks the names, texts, kinds and registers of plots and messages, in a program with these numbers of registers and
    /// states.
    pub(super) fn verify(&self, registers: usize, states: usize) -> Result<(), Unsound> {
        let is_unfit = |text: &str| text.len() > DESCRIPTION_LIMIT || text.chars().any(char::is_control);
        let register = |register: Register, width| within("register", usize::from(register) + width - 1, registers);
        if !self.plots.is_empty() || !self.messages.is_empty() {
            register(self.counter, 1)?;
        }
        distinct(self.plots.iter().map(|plot| plot.name.as_str()))?;
        for plot in &self.plots {
            is_name(&plot.name)?;
            if matches!(plot.kind, OutputKind::Vector(_) | OutputKind::Whisker) {
                return Err(Unsound::Output(plot.name.clone()));
            }
            register(plot.value, 1)?;
            register(plot.number, 1)?;
        }
        for Message { state, text, values, number } in &self.messages {
            let width: usize = values.iter().map(|value| value.kind.width()).sum();
            if is_unfit(text) || width > NUMBERS_LIMIT || values.iter().any(|value| is_unfit(&value.name)) {
                return Err(Unsound::Output(text.to_string()));
            }
            state.map_or(Ok(()), |state| within("state", state, states))?;
            register(*number, 1)?;
            values.iter().try_for_each(|value| register(value.value, value.kind.width()))?;
        }
        Ok(())
    }
}

impl OutputKind {
    /// Number of registers of a value.
    #[must_use]
    pub fn width(&self) -> usize {
        if let Self::Vector(_) = self { 2 } else { 1 }
    }

    /// The value in `numbers`. `whiskers` are the names of the program's whiskers. `None` if there is no such value.
    #[must_use]
    pub fn read(&self, numbers: &[f64], whiskers: &[String]) -> Option<Shown> {
        let &first = numbers.first()?;
        let named = |names: &[String]| {
            let mut numbered = names.iter().enumerate();
            numbered
                .find(|(index, _)| (*index as f64).to_bits() == first.to_bits())
                .map(|(_, name)| Shown::Name(name.clone()))
        };
        match self {
            Self::Number(dimension) => Some(Shown::Number(first, *dimension)),
            Self::Truth => Some(Shown::Truth(first > 0.5)),
            Self::Choice(names) => named(names),
            Self::Vector(dimension) => Some(Shown::Vector(Vector2::new(first, *numbers.get(1)?), *dimension)),
            Self::Whisker => named(whiskers),
        }
    }
}

impl Message {
    /// The numbers of all values, one value after the other, from the registers of a machine.
    pub(super) fn numbers(&self, registers: &[f64]) -> [f64; NUMBERS_LIMIT] {
        let mut numbers = [0.0; NUMBERS_LIMIT];
        let read = self.values.iter().flat_map(|value| {
            let first = usize::from(value.value);
            registers.iter().skip(first).take(value.kind.width())
        });
        numbers.iter_mut().zip(read).for_each(|(number, read)| *number = *read);
        numbers
    }

    /// The message with its values. `numbers` are those of a [`LoggedMessage`], and `whiskers` the names of the program's
    /// whiskers.
    #[must_use]
    pub fn shown(&self, numbers: &[f64; NUMBERS_LIMIT], whiskers: &[String]) -> ShownMessage {
        let mut next = 0;
        let values = self.values.iter().filter_map(|value| {
            let first = next;
            next += value.kind.width();
            Some((Arc::clone(&value.name), value.kind.read(numbers.get(first..)?, whiskers)?))
        });
        ShownMessage { text: Arc::clone(&self.text), values: values.collect() }
    }
}

/// A message with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownMessage {
    /// The text.
    pub text: Arc<str>,
    /// The expressions, each with its value.
    pub values: Vec<(Arc<str>, Shown)>,
}

/// The text with all values, as in `the edge was lost: w = r0, |w.base_angle| = 120 urad`.
impl fmt::Display for ShownMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)?;
        for (index, (name, value)) in self.values.iter().enumerate() {
            write!(f, "{} {name} = {value}", if index == 0 { ":" } else { "," })?;
        }
        Ok(())
    }
}

/// A message that a tick has logged. It has a fixed size, so that it can be passed on without memory from the heap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoggedMessage {
    /// Index of the message in [`Outputs::messages`].
    pub message: usize,
    /// The numbers of its values, for [`Message::shown`].
    pub numbers: [f64; NUMBERS_LIMIT],
}
