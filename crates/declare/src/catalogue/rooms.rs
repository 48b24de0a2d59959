//! `rooms`

use std::f64::consts::{FRAC_PI_2, PI};

use super::common::{SPEED, START_HEADING, START_X, START_Y};
use super::{Entry, Parameter};

/// The clear sizes of the floor.
pub const LENGTH: Parameter = Parameter::length("length", "clear length between the walls", (1.5, 3.0)).simplest(2.0);
pub const WIDTH: Parameter = Parameter::length("width", "clear width between the walls", (1.5, 3.0)).simplest(2.0);
pub const THICKNESS: Parameter = Parameter::length("thickness", "thickness of the walls", (0.02, 0.06)).simplest(0.04);
/// Rotation of the floor. It keeps walls from being parallel to the axes.
pub const TURN: Parameter = Parameter::angle("turn", "rotation of the walls", (0.0, FRAC_PI_2));
pub const DOORS: Parameter = Parameter::stepped("doors", "number of doors", (1.0, 2.0), 1.0);
pub const DOOR_PLACES: [Parameter; 2] = [door_place("door_place_1"), door_place("door_place_2")];
/// The smallest door is 1.3 times as wide as the body of the reference rig, which is 120 mm wide.
pub const DOOR_WIDTHS: [Parameter; 2] = [door_width("door_width_1"), door_width("door_width_2")];
/// The start, before it is displaced.
pub const AT_X: Parameter = Parameter::share("at_x", "position of the start along the length", (0.0, 1.0));
pub const AT_Y: Parameter = Parameter::share("at_y", "position of the start along the width", (0.0, 1.0));
pub const AT_HEADING: Parameter = Parameter::angle("at_heading", "heading of the start, against the walls", (-PI, PI))
    .in_steps(PI / 180.0)
    .simplest(0.0);
pub const OBJECTS: Parameter = Parameter::stepped("objects", "number of objects", (3.0, 8.0), 1.0);

/// The parameters of the objects, each with one entry per object.
pub const KINDS: [Parameter; 8] = numbered(
    ["kind_1", "kind_2", "kind_3", "kind_4", "kind_5", "kind_6", "kind_7", "kind_8"],
    Parameter::stepped("", "0 for a disk, 1 for a box, 2 for a regular polygon, 3 for a pole", (0.0, 3.0), 1.0),
);
pub const SIZES: [Parameter; 8] = numbered(
    ["size_1", "size_2", "size_3", "size_4", "size_5", "size_6", "size_7", "size_8"],
    Parameter::share("", "size of the object, from the smallest to the largest of its kind", (0.0, 1.0)),
);
pub const ASPECTS: [Parameter; 8] = numbered(
    ["aspect_1", "aspect_2", "aspect_3", "aspect_4", "aspect_5", "aspect_6", "aspect_7", "aspect_8"],
    Parameter::share("", "width of a box as a share of its length", (0.3, 1.0)).simplest(1.0),
);
pub const CORNERS: [Parameter; 8] = numbered(
    ["corners_1", "corners_2", "corners_3", "corners_4", "corners_5", "corners_6", "corners_7", "corners_8"],
    Parameter::stepped("", "number of corners of a polygon", (3.0, 7.0), 1.0),
);
pub const PHASES: [Parameter; 8] = numbered(
    ["phase_1", "phase_2", "phase_3", "phase_4", "phase_5", "phase_6", "phase_7", "phase_8"],
    Parameter::angle("", "rotation of the object", (0.0, PI)).in_steps(PI / 180.0),
);
pub const XS: [Parameter; 8] = numbered(
    ["x_1", "x_2", "x_3", "x_4", "x_5", "x_6", "x_7", "x_8"],
    Parameter::share("", "wanted position of the object along the length of the floor", (0.0, 1.0)),
);
pub const YS: [Parameter; 8] = numbered(
    ["y_1", "y_2", "y_3", "y_4", "y_5", "y_6", "y_7", "y_8"],
    Parameter::share("", "wanted position of the object along the width of the floor", (0.0, 1.0)),
);
pub const CONTACTS: [Parameter; 8] = numbered(
    ["contact_1", "contact_2", "contact_3", "contact_4", "contact_5", "contact_6", "contact_7", "contact_8"],
    Parameter::stepped(
        "",
        "0 for an object that stands free, 1 against a wall, 2 against another object or, if there is none, a wall",
        (0.0, 2.0),
        1.0,
    ),
);

const fn door_place(name: &'static str) -> Parameter {
    Parameter::share(name, "position of the door along the walls", (0.0, 1.0))
}

const fn door_width(name: &'static str) -> Parameter {
    Parameter::length(name, "clear width of the door", (0.156, 0.4)).within((0.13, 0.6)).simplest(0.3)
}

const fn numbered(names: [&'static str; 8], parameter: Parameter) -> [Parameter; 8] {
    let mut all = [parameter; 8];
    let mut index = 0;
    while index < names.len() {
        all[index].name = names[index];
        index += 1;
    }
    all
}

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "rooms",
    about: "four walls of 1.5 to 3 m with one or two doors, around 3 to 8 disks, boxes, polygons and poles",
    parameters: &{
        const HEAD: [Parameter; 3] = [START_X, START_Y, START_HEADING];
        const ROOM: [Parameter; 14] = [
            AT_X,
            AT_Y,
            AT_HEADING,
            TURN,
            THICKNESS,
            DOOR_PLACES[0],
            DOOR_PLACES[1],
            DOOR_WIDTHS[0],
            DOOR_WIDTHS[1],
            DOORS,
            LENGTH,
            WIDTH,
            SPEED,
            OBJECTS,
        ];
        const OF_OBJECTS: [[Parameter; 8]; 8] = [PHASES, ASPECTS, CORNERS, XS, YS, SIZES, CONTACTS, KINDS];
        let mut all = [SPEED; 3 + 14 + 64];
        let mut index = 0;
        while index < all.len() {
            all[index] = match index {
                0..3 => HEAD[index],
                3..67 => OF_OBJECTS[(index - 3) / 8][(index - 3) % 8],
                _ => ROOM[index - 67],
            };
            index += 1;
        }
        all
    },
};
