//! A look into a running policy: how far each guard is from being enabled, and why transitions are taken.

mod breakpoint;
mod difference;
mod inspector;
mod records;

pub use breakpoint::{Breakpoint, Breakpoints};
pub use difference::{DifferentTick, PolicyDifference, PolicyTick, first_difference};
pub use inspector::Inspector;
pub use records::{GuardRecord, LeafRecord, Margin, StopRecord, TransitionLine, VariableRecord, ViolationLine};
