//! The compiled machine and its evaluator. A robot needs nothing else of a policy.
//!
//! A [`Program`] is flat code over a file of registers. A [`Machine`] executes it. Every tick reads [`Senses`], takes
//! enabled transitions and gives one [`Action`]. A tick does a bounded amount of work and allocates nothing: jumps only
//! go forward, and the number of transitions is limited. An [`Artifact`] is a program as bytes.

mod action;
mod activity;
mod artifact;
mod configuration;
mod contact_estimator_kind;
mod contour;
mod contract;
mod evaluate;
mod fallback;
mod needs;
mod observer;
mod op;
mod operands;
mod output;
mod parameter;
mod program;
mod senses;
mod source_map;
mod stateful;
mod tick;
mod unsound;
mod verify;

pub use activity::TIME_SLACK;
pub use evaluate::compute;
pub use operands::{Effect, Index, Operands, RegisterSpan, Role};

pub use action::{Action, ActionPart, Mover, NonFinite, Turn};
pub use artifact::{ARTIFACT_LIMIT, Artifact, ArtifactError, FORMAT, MAGIC, Origin};
pub use contact_estimator_kind::ContactEstimatorKind;
pub use contour::{Keypoints, PositionContour};
pub use contract::{CONTRACT_LIMIT, Contract, ContractStatus, Moment, ObservedContract, TimedMargin};
pub use fallback::{Cause, Fallback};
pub use needs::{Needs, RateRange, UnmetRate};
pub use observer::{ContractId, Duration, Observer, Standing, TransitionId, TriedGuard, ViolatedContract};
pub use op::{Block, Op, Register, Wide};
pub use output::{
    LoggedMessage, MESSAGE_LIMIT, Message, MessageValue, NUMBERS_LIMIT, OutputKind, Outputs, PLOT_LIMIT, Plot, Shown,
    ShownMessage,
};
pub use parameter::{DESCRIPTION_LIMIT, Parameter, ParameterValue, SetError};
pub use program::{
    CODE_LIMIT, CONTOUR_LIMIT, Guard, NESTING_LIMIT, OnlySimulated, Program, REGISTER_LIMIT, State, Target, Transition,
};
pub use senses::{
    BodyScalar, ContourVector, MapQuestion, MapScalar, MapVector, Mark, Senses, WhiskerScalar, WhiskerVector,
};
pub use source_map::{Position, SourceMap, StatePosition};
pub use tick::{Failure, MICROSTEP_LIMIT, Machine, Status, Tick};
pub use unsound::Unsound;
