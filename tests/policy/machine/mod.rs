//! The machine that a policy compiles to.

pub(crate) mod artifact;
mod behaviour;
mod contract;
mod memory;
mod monitor;
mod nesting;
mod output;
mod tick;
