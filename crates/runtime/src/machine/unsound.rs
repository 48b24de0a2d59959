//! Defects of programs from untrusted sources.

use super::op::Register;
use super::parameter::DESCRIPTION_LIMIT;
use super::program::NESTING_LIMIT;

/// A defect that makes a program unsafe to run.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unsound {
    /// The number of something exceeds its limit.
    #[error("it has {count} {what}, {limit} at most are allowed")]
    TooMany {
        /// The things counted.
        what: &'static str,
        /// Their number.
        count: usize,
        /// The limit.
        limit: usize,
    },
    /// An index is out of range.
    #[error("it names {what} {index} of {count}")]
    Index {
        /// The kind of thing indexed.
        what: &'static str,
        /// The index.
        index: usize,
        /// Number of existing things of this kind.
        count: usize,
    },
    /// A block is outside of the code, or overlaps another block.
    #[error("its block of code from {start} to {end} lies outside of the code or crosses another block")]
    Block {
        /// The first operation.
        start: u32,
        /// The end, exclusive.
        end: u32,
    },
    /// A jump goes back or out of its block.
    #[error("its jump at {at} leads to {target}, which is not ahead in the same block")]
    Jump {
        /// Index of the jump.
        at: u32,
        /// Its target.
        target: u32,
    },
    /// A tick in a state would execute the same code more than once.
    #[error("its state {state} has {operations} operations a tick, more than its code has")]
    Work {
        /// Index of the state.
        state: usize,
        /// Operations of all blocks of the state, its outer states and the program.
        operations: usize,
    },
    /// An outer state does not come before its inner state, or the nesting is too deep.
    #[error("its state {0} has an invalid outer state, or is nested more than {NESTING_LIMIT} deep")]
    Nesting(usize),
    /// A monitor does more than change memory.
    #[error("its monitors record, or give a command")]
    Monitor,
    /// A plot or a message has an invalid name, text or kind.
    #[error("its plot or message `{0}` has an invalid name, text or kind of value")]
    Output(String),
    /// A contract does more than compute, or its text is not one short line.
    #[error("its contract `{0}` records or gives a command, or its text is not one short line")]
    Contract(String),
    /// The initial state of a state is missing or is not one of its inner states, or a state without inner states is
    /// resumed.
    #[error("its state {0} has an invalid initial state")]
    InitialState(usize),
    /// A timer of a global transition is used by a state, or the reverse.
    #[error("its timer {0} belongs to another guard")]
    Timer(usize),
    /// A register that is read as a whisker can contain something else.
    #[error("its register {0} is read as a whisker, but can hold something else")]
    Whisker(Register),
    /// A register that is read as a contour can contain something else.
    #[error("its register {0} is read as a contour, but can hold something else")]
    Contour(Register),
    /// The number or the spacing of the keypoints of a contour is outside of its range.
    #[error("the keypoints of a contour of it are too few, too many, too close or too far apart")]
    Keypoints,
    /// Whiskers are read, but none is bound.
    #[error("it reads whiskers, but binds none; bind one, as in `whisker r0`")]
    NoWhisker,
    /// The code changes a parameter.
    #[error("its code changes the parameter `{0}`")]
    ParameterWritten(String),
    /// An initial register is not finite.
    #[error("its register {0} starts with a number that is not finite")]
    NotFinite(usize),
    /// The range of a parameter is invalid, or its value is outside of the range.
    #[error("its parameter `{0}` is outside of its range")]
    OutOfRange(String),
    /// The description of a parameter is too long or not one line of plain text.
    #[error("the description of its parameter `{0}` is longer than {DESCRIPTION_LIMIT} bytes, or has several lines")]
    Description(String),
    /// The needs that it states are not positive, not in order, or without a whole ratio of the rates.
    #[error("its needs are not positive, not in order, or have no whole ratio of the rates")]
    Needs,
    /// A name is not an identifier of the language.
    #[error("{0:?} is not a name")]
    Name(String),
    /// Two things have the same name.
    #[error("the name `{0}` occurs twice")]
    SameName(String),
    /// The reason of a failure or a success is not one line of plain text.
    #[error("the reason {0:?} has characters that cannot be shown; reword it")]
    Reason(String),
}
