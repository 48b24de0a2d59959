//! `zigzag-tunnel`

use std::f64::consts::PI;

use super::common::{MOUTH_AHEAD, SPEED, START_HEADING, START_X, START_Y, WIDTH};
use super::{Entry, Parameter};

pub const ANGLE: Parameter =
    Parameter::angle("angle", "angle of each corner", (PI / 18.0, PI / 3.0)).within((0.0, PI / 3.0));
pub const LENGTH: Parameter =
    Parameter::length("length", "length of each section", (0.22, 0.35)).within((0.1, 1.0)).simplest(0.3);
pub const SECTIONS: Parameter =
    Parameter::stepped("sections", "number of sections", (4.0, 6.0), 1.0).within((1.0, 12.0));
/// Sign of the first corner.
pub const SIDE: Parameter =
    Parameter::stepped("side", "1 if the first corner turns left, -1 if it turns right", (-1.0, 1.0), 2.0)
        .simplest(1.0);

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "zigzag-tunnel",
    about: "a tunnel of straight runs with alternating turns of 10° to 60°, and a free width of 18 to 26 cm",
    parameters: &[START_X, START_Y, START_HEADING, MOUTH_AHEAD, LENGTH, SECTIONS, SIDE, SPEED, WIDTH, ANGLE],
};
