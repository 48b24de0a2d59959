//! The YAML format of a scenario: from text to a checked [`Scene`](super::Scene).
//!
//! The parser gives a tree in which every node knows its place; reading walks the tree, and puts what is wrong on a list
//! instead of stopping at it. Checks that take several values together come last and run on what could be read.

mod budget;
mod change;
mod expect;
mod fault;
mod fields;
mod file;
mod key;
mod node;
mod number;
mod object;
mod objects;
mod outline;
mod path;
mod polar;
mod reader;
mod rig;
mod scene;
mod start;
mod stop;
mod sweep;
mod timing;
mod tunnel;
mod whisker;

pub(super) use change::{Change, quoted, read as read_changed};
pub(super) use file::unreadable;
pub(super) use scene::read;
pub(super) use sweep::{read as read_sweep, unfit};
