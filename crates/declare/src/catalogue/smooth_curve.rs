//! `smooth-curve`

use std::f64::consts::PI;

use super::common::{AHEAD, ASIDE, SIDE, SPEED, START_HEADING, START_X, START_Y};
use super::{Entry, Parameter};

pub const RADIUS: Parameter = Parameter::length("radius", "mean radius", (0.2, 0.35)).within((0.1, 1.0)).simplest(0.3);
/// Waves of orders 2 to 5. An amplitude is the share times the radius, divided by the order.
pub const WAVES: [Parameter; 4] = [wave("wave_2"), wave("wave_3"), wave("wave_4"), wave("wave_5")];
/// Phases of these waves.
pub const PHASES: [Parameter; 4] = [phase("phase_2"), phase("phase_3"), phase("phase_4"), phase("phase_5")];

const fn wave(name: &'static str) -> Parameter {
    Parameter::share(name, "amplitude of this wave times its order, as a share of the radius", (0.0, 0.4))
}

const fn phase(name: &'static str) -> Parameter {
    Parameter::angle(name, "phase of this wave", (-PI, PI)).in_steps(PI / 180.0).simplest(0.0)
}

/// The entry of the family.
pub static ENTRY: Entry = Entry {
    name: "smooth-curve",
    about: "a smooth closed curve with up to five bulges, and radii of at least 8 cm outwards and 25 cm inwards",
    parameters: &[
        START_X,
        START_Y,
        START_HEADING,
        WAVES[0],
        WAVES[1],
        WAVES[2],
        WAVES[3],
        PHASES[0],
        PHASES[1],
        PHASES[2],
        PHASES[3],
        AHEAD,
        ASIDE,
        RADIUS,
        SIDE,
        SPEED,
    ],
};
