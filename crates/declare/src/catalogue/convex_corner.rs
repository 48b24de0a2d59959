//! `convex-corner`

use std::f64::consts::PI;

use super::common::{FLANK_AHEAD, SIDE, SPEED, START_HEADING, START_X, START_Y, TILT};
use super::{Entry, Parameter};

pub const ANGLE: Parameter = Parameter::angle("angle", "angle by which the outline turns at the gable", (PI / 6.0, PI))
    .within((PI / 18.0, PI))
    .simplest(0.5 * PI);
pub const ROOF: Parameter =
    Parameter::length("roof", "length of the sides beside the gable", (0.25, 0.4)).within((0.1, 1.0));
pub const WALL: Parameter =
    Parameter::length("wall", "length of the sides behind the roofs", (0.1, 0.25)).within((0.05, 1.0));
pub const THICKNESS: Parameter =
    Parameter::length("thickness", "thickness of a blade, above 172 deg", (2e-3, 5e-3)).in_steps(1e-4);

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "convex-corner",
    about: "a convex corner that turns by 30° to 180°: houses with flat and steep gables, wedges, blades",
    parameters: &[START_X, START_Y, START_HEADING, TILT, FLANK_AHEAD, ROOF, WALL, THICKNESS, SIDE, SPEED, ANGLE],
};
