//! Reading of YAML texts: a tree with positions, values with units, and the rig.
//!
//! [`parse`] returns a tree in which every node has its span. A [`Reader`] takes values from it and collects diagnostics
//! instead of stopping at the first. [`rig`] reads a rig, in a scenario and in the configuration of a robot.
//!
//! # Where to begin
//!
//! A value with a new form is a function of `value.rs`. The messages for unknown words and wrong types are in
//! `reader.rs`, and those for numbers and units in `number.rs`. The keys of a rig are not here: they are entries of the crate `declare`.

mod calibration;
pub mod fault;
mod fields;
mod node;
mod number;
mod parse;
mod reader;
pub mod rig;
mod value;

pub use calibration::{CALIBRATION_FORMAT, CalibrationError, read_calibration};
pub use fields::{Fields, list};
pub use node::{Entry, Node, Placed};
pub use parse::{parse, root_place};
pub use reader::{Files, Reader, number_text, written};
pub use value::{Fault, read_value};
