//! `polygon`

use super::common::{AHEAD, ASIDE, SIDE, SPEED, START_HEADING, START_X, START_Y, phase, shift};
use super::{Entry, Parameter};

pub const RADIUS: Parameter =
    Parameter::length("radius", "radius of the circle with the corners", (0.2, 0.35)).within((0.1, 1.0)).simplest(0.3);
pub const CORNERS: Parameter = Parameter::stepped("corners", "number of corners", (3.0, 8.0), 1.0).simplest(4.0);
pub const PHASE: Parameter = phase("phase");
pub const SHIFTS: [Parameter; 8] = [
    shift("shift_1"),
    shift("shift_2"),
    shift("shift_3"),
    shift("shift_4"),
    shift("shift_5"),
    shift("shift_6"),
    shift("shift_7"),
    shift("shift_8"),
];
/// Radii of all corners but the first.
pub const ROUNDINGS: [Parameter; 7] = [
    rounding("rounding_2"),
    rounding("rounding_3"),
    rounding("rounding_4"),
    rounding("rounding_5"),
    rounding("rounding_6"),
    rounding("rounding_7"),
    rounding("rounding_8"),
];

const fn rounding(name: &'static str) -> Parameter {
    Parameter::length(name, "radius of this corner, 0 for a sharp one. Sides that are too short reduce it", (0.0, 0.1))
}

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "polygon",
    about: "a convex polygon of 3 to 8 corners, each sharp or, if the sides are long enough, rounded by 2 to 10 cm",
    parameters: &[
        START_X,
        START_Y,
        START_HEADING,
        SHIFTS[0],
        SHIFTS[1],
        SHIFTS[2],
        SHIFTS[3],
        SHIFTS[4],
        SHIFTS[5],
        SHIFTS[6],
        SHIFTS[7],
        ROUNDINGS[0],
        ROUNDINGS[1],
        ROUNDINGS[2],
        ROUNDINGS[3],
        ROUNDINGS[4],
        ROUNDINGS[5],
        ROUNDINGS[6],
        PHASE,
        AHEAD,
        ASIDE,
        RADIUS,
        SIDE,
        SPEED,
        CORNERS,
    ],
};
