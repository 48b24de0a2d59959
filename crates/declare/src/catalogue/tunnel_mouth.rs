//! `tunnel-mouth`

use super::common::{MOUTH_AHEAD, SPEED, START_HEADING, START_X, START_Y, WIDTH};
use super::{Entry, Parameter};

pub const THICKNESS: Parameter =
    Parameter::length("thickness", "thickness of the walls", (5e-3, 0.04)).within((1e-3, 0.1)).simplest(0.02);
pub const LENGTH: Parameter = Parameter::length("length", "length of the tunnel", (0.5, 0.9)).within((0.2, 3.0));

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "tunnel-mouth",
    about: "a straight tunnel with a free width of 18 to 26 cm and walls of 5 to 40 mm",
    parameters: &[START_X, START_Y, START_HEADING, MOUTH_AHEAD, LENGTH, THICKNESS, SPEED, WIDTH],
};
