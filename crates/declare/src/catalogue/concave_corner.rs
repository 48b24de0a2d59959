//! `concave-corner`

use std::f64::consts::PI;

use super::common::{FLANK_AHEAD, SIDE, SPEED, START_HEADING, START_X, START_Y, TILT};
use super::{Entry, Parameter};

pub const ANGLE: Parameter = Parameter::angle(
    "angle",
    "angle by which the outline turns at the inner corner",
    (15.0 / 180.0 * PI, 75.0 / 180.0 * PI),
)
.within((PI / 36.0, 0.5 * PI))
.simplest(0.25 * PI);
pub const FIRST: Parameter = Parameter::length("first", "length of the first side", (0.4, 0.55)).within((0.2, 1.0));
pub const SECOND: Parameter = Parameter::length("second", "length of the second side", (0.25, 0.4)).within((0.1, 1.0));
pub const THICKNESS: Parameter =
    Parameter::length("thickness", "thickness of the bar", (0.15, 0.25)).within((0.02, 0.5));

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "concave-corner",
    about: "an L-shaped bar with an inner corner of 15° to 75°",
    parameters: &[START_X, START_Y, START_HEADING, TILT, FLANK_AHEAD, FIRST, SECOND, THICKNESS, SIDE, SPEED, ANGLE],
};
