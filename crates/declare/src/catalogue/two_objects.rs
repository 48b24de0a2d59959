//! `two-objects`

use super::common::{AHEAD, ASIDE, SIDE, SPEED, START_HEADING, START_X, START_Y, phase, shift};
use super::{Entry, Parameter};

/// The parameters of one of the objects.
pub struct ObjectParameters {
    pub radius: Parameter,
    pub corners: Parameter,
    pub phase: Parameter,
    pub shifts: [Parameter; 6],
}

pub const FIRST: ObjectParameters = ObjectParameters {
    radius: radius("first_radius", (0.14, 0.2)),
    corners: corners("first_corners"),
    phase: phase("first_phase"),
    shifts: [
        shift("first_shift_1"),
        shift("first_shift_2"),
        shift("first_shift_3"),
        shift("first_shift_4"),
        shift("first_shift_5"),
        shift("first_shift_6"),
    ],
};
pub const SECOND: ObjectParameters = ObjectParameters {
    radius: radius("second_radius", (0.1, 0.2)),
    corners: corners("second_corners"),
    phase: phase("second_phase"),
    shifts: [
        shift("second_shift_1"),
        shift("second_shift_2"),
        shift("second_shift_3"),
        shift("second_shift_4"),
        shift("second_shift_5"),
        shift("second_shift_6"),
    ],
};
pub const GAP: Parameter = Parameter::length("gap", "distance between the circles around the objects", (0.05, 0.6))
    .within((0.02, 2.0))
    .simplest(0.6);
pub const DIRECTION: Parameter =
    Parameter::angle("direction", "direction from the first object to the second. 0 is to the side", (-0.3, 1.3))
        .simplest(0.0);

const fn radius(name: &'static str, range: (f64, f64)) -> Parameter {
    Parameter::length(name, "radius of the circle around the object", range).within((0.05, 0.5)).simplest(range.1)
}

const fn corners(name: &'static str) -> Parameter {
    Parameter::stepped(name, "number of corners. 2 stands for a disk", (2.0, 6.0), 1.0)
}

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "two-objects",
    about: "two disks or polygons side by side, 5 to 60 cm apart",
    parameters: &[
        START_X,
        START_Y,
        START_HEADING,
        FIRST.shifts[0],
        FIRST.shifts[1],
        FIRST.shifts[2],
        FIRST.shifts[3],
        FIRST.shifts[4],
        FIRST.shifts[5],
        SECOND.shifts[0],
        SECOND.shifts[1],
        SECOND.shifts[2],
        SECOND.shifts[3],
        SECOND.shifts[4],
        SECOND.shifts[5],
        FIRST.phase,
        SECOND.phase,
        FIRST.corners,
        SECOND.corners,
        FIRST.radius,
        SECOND.radius,
        DIRECTION,
        AHEAD,
        ASIDE,
        SIDE,
        SPEED,
        GAP,
    ],
};
