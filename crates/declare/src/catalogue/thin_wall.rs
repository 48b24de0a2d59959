//! `thin-wall`

use super::common::{FLANK_AHEAD, SIDE, SPEED, START_HEADING, START_X, START_Y, TILT};
use super::{Entry, Parameter};

pub const LENGTH: Parameter =
    Parameter::length("length", "length of the wall", (0.3, 0.6)).within((0.1, 2.0)).simplest(0.4);
pub const THICKNESS: Parameter = Parameter::length("thickness", "thickness of the wall", (2e-3, 0.02))
    .within((1e-3, 0.1))
    .simplest(0.02)
    .in_steps(1e-4);

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "thin-wall",
    about: "a free-standing straight wall, 2 to 20 mm thick",
    parameters: &[START_X, START_Y, START_HEADING, TILT, FLANK_AHEAD, LENGTH, SIDE, SPEED, THICKNESS],
};
