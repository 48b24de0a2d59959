//! The elastica against closed solutions, against the chain, and against what holds of every equilibrium.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod closed_form;
mod equilibria;
mod fine_chain;
mod locate;
mod whisker;
