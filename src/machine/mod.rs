//! The compiled machine and its evaluator: what a policy becomes, and all of it that a robot carries.
//!
//! A [`Program`] is flat code over a file of registers. A [`Machine`] runs it: every tick reads [`Senses`], takes the
//! transitions that are due, and gives one [`Action`]. A tick does a bounded amount of work (jumps only go forward, chains of
//! transitions are limited) and allocates nothing.

mod action;
mod evaluate;
mod op;
mod program;
mod senses;
mod stateful;
mod tick;

pub(crate) use evaluate::evaluate;
pub(crate) use tick::TIME_SLACK;

pub use action::{Action, Mover, Turn};
pub use op::{Block, Op, Register, Wide};
pub use program::{Guard, Parameter, Program, SetError, State, Target, Transition};
pub use senses::{BodyScalar, Senses, WhiskerScalar, WhiskerVector};
pub use tick::{CHAIN_LIMIT, Failure, Machine, Outcome, Tick};
