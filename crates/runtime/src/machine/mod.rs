//! The compiled machine and its evaluator: what a policy becomes, and all of it that a robot carries.
//!
//! A [`Program`] is flat code over a file of registers. A [`Machine`] runs it: every tick reads [`Senses`], takes the
//! transitions that are due, and gives one [`Action`]. A tick does a bounded amount of work (jumps only go forward, chains of
//! transitions are limited) and allocates nothing. An [`Artifact`] is a program as bytes.

mod action;
mod activity;
mod artifact;
mod evaluate;
mod failsafe;
mod op;
mod operands;
mod program;
mod senses;
mod source_map;
mod stateful;
mod tick;
mod tip_model_kind;
mod verify;
mod way;

pub use activity::TIME_SLACK;
pub use evaluate::compute;
pub use operands::{Effect, Operands, Place, Role};

pub use action::{Action, ActionPart, Flaw, Mover, Turn};
pub use artifact::{ARTIFACT_LIMIT, Artifact, ArtifactError, FORMAT, MAGIC, Origin};
pub use failsafe::{Cause, Failsafe};
pub use op::{Block, Op, Register, Wide};
pub use program::{
    CODE_LIMIT, DESCRIPTION_LIMIT, Guard, NESTING_LIMIT, Parameter, Program, REGISTER_LIMIT, SetError, State, Target,
    Transition,
};
pub use senses::{BodyScalar, ContourVector, Mark, Senses, WhiskerScalar, WhiskerVector};
pub use source_map::{Position, SourceMap, StatePlace};
pub use tick::{CHAIN_LIMIT, Failure, Machine, Status, Tick};
pub use tip_model_kind::TipModelKind;
pub use verify::Unsound;
