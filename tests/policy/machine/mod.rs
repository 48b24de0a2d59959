//! The machine that a policy compiles to.

pub(crate) mod artifact;
mod memory;
mod nesting;
mod tick;
