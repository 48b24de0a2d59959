//! A look into a running policy: how far each guard is from being enabled, and why transitions are taken.

mod breakpoint;
mod difference;
mod explained_control;
mod inspector;
mod near_miss;
mod records;
mod tried_guards;

pub use breakpoint::{Breakpoint, Breakpoints};
pub use breakpoint::{BreakpointTick, BreakpointWatch};
pub use difference::{DifferentTick, PolicyDifference, PolicyPair, PolicyTick, first_difference};
pub use explained_control::ExplainedControl;
pub use inspector::Inspector;
pub use near_miss::{NearMiss, NearMisses};
pub use records::{GuardRecord, LeafRecord, Margin, StopRecord, TransitionLine, VariableRecord, ViolationLine};
pub use tried_guards::TriedGuards;
