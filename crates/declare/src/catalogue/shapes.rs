//! `shapes`

use std::f64::consts::PI;

use super::common::{AHEAD, ASIDE, SIDE, SPEED, START_HEADING, START_X, START_Y};
use super::{Entry, Parameter};

/// The outline before its features are added or removed.
pub const BASE: Parameter = Parameter::stepped("base", "0 for a rectangle, 1 for a disk", (0.0, 1.0), 1.0);
pub const ASPECT: Parameter =
    Parameter::share("aspect", "width of the rectangle as a share of its length", (0.4, 1.0)).simplest(1.0);
/// The kinds of the features.
pub const KINDS: [Parameter; 4] = [kind("kind_1"), kind("kind_2"), kind("kind_3"), kind("kind_4")];
pub const PLACES: [Parameter; 4] = [place("place_1"), place("place_2"), place("place_3"), place("place_4")];
pub const LEANS: [Parameter; 4] = [lean("lean_1"), lean("lean_2"), lean("lean_3"), lean("lean_4")];
pub const WIDTHS: [Parameter; 4] = [width("width_1"), width("width_2"), width("width_3"), width("width_4")];
pub const DEPTHS: [Parameter; 4] = [depth("depth_1"), depth("depth_2"), depth("depth_3"), depth("depth_4")];
pub const TEETH: Parameter = Parameter::stepped("teeth", "number of teeth of a row", (3.0, 6.0), 1.0);
pub const CONVEX_RADIUS: Parameter = radius("convex_radius", "radius of rounded convex corners, 0 for sharp ones");
pub const CONCAVE_RADIUS: Parameter = radius("concave_radius", "radius of rounded concave corners, 0 for sharp ones");
pub const ROUNDED: Parameter =
    Parameter::share("rounded", "share of the corners between straight sides that are rounded", (0.0, 1.0));
pub const TURN: Parameter = Parameter::angle("turn", "rotation of the object", (0.0, 2.0 * PI)).in_steps(PI / 180.0);
pub const SIZE: Parameter = Parameter::length("size", "largest distance between two points of the object", (0.3, 0.9))
    .within((0.1, 2.0))
    .simplest(0.6);

/// A random shape has four features, unless one does not fit.
const fn kind(name: &'static str) -> Parameter {
    Parameter::stepped(
        name,
        "feature: 0 none, 1 rectangular boss, 2 round boss, 3 notch, 4 round bite, 5 slot, 6 row of teeth",
        (1.0, 6.0),
        1.0,
    )
    .within((0.0, 6.0))
    .simplest(0.0)
}

const fn place(name: &'static str) -> Parameter {
    Parameter::share(name, "position of the feature along the outline of the base", (0.0, 1.0))
}

const fn lean(name: &'static str) -> Parameter {
    Parameter::angle(name, "rotation of the feature against the normal", (-PI / 6.0, PI / 6.0)).simplest(0.0)
}

const fn width(name: &'static str) -> Parameter {
    Parameter::share(name, "width of the feature, from the smallest to the largest of its kind", (0.0, 1.0))
}

const fn depth(name: &'static str) -> Parameter {
    Parameter::share(name, "height or depth of the feature, from the smallest to the largest of its kind", (0.0, 1.0))
}

const fn radius(name: &'static str, about: &'static str) -> Parameter {
    Parameter::length(name, about, (0.0, 0.03))
}

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "shapes",
    about: "a rectangle or disk with up to four bosses, notches, bites, slots and rows of teeth, 30 to 90 cm across",
    parameters: &[
        START_X,
        START_Y,
        START_HEADING,
        LEANS[0],
        LEANS[1],
        LEANS[2],
        LEANS[3],
        PLACES[0],
        PLACES[1],
        PLACES[2],
        PLACES[3],
        WIDTHS[0],
        WIDTHS[1],
        WIDTHS[2],
        WIDTHS[3],
        DEPTHS[0],
        DEPTHS[1],
        DEPTHS[2],
        DEPTHS[3],
        CONVEX_RADIUS,
        CONCAVE_RADIUS,
        ROUNDED,
        TURN,
        AHEAD,
        ASIDE,
        TEETH,
        ASPECT,
        BASE,
        SIZE,
        SIDE,
        SPEED,
        KINDS[0],
        KINDS[1],
        KINDS[2],
        KINDS[3],
    ],
};
