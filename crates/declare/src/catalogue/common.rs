//! Parameters that several families have.

use std::f64::consts::{FRAC_PI_6, PI};

use super::Parameter;

/// Displacements of the start, and the speed of the policy.
pub const START_X: Parameter =
    Parameter::length("start_x", "displacement of the start along x", (-0.04, 0.04)).simplest(0.0);
pub const START_Y: Parameter =
    Parameter::length("start_y", "displacement of the start along y", (-0.04, 0.04)).simplest(0.0);
pub const START_HEADING: Parameter =
    Parameter::angle("start_heading", "rotation of the start", (-FRAC_PI_6, FRAC_PI_6)).simplest(0.0);
pub const SPEED: Parameter = Parameter::speed(
    "speed",
    "value of the policy's parameter `speed`. `families` samples 2, 5 or 10 cm/s",
    (0.02, 0.1),
)
.within((1e-3, 0.5))
.simplest(0.05);

/// The side of an object.
pub const SIDE: Parameter =
    Parameter::stepped("side", "1 for an object on the right, -1 for one on the left", (-1.0, 1.0), 2.0).simplest(1.0);

/// Rotation of an object with a flank against the path of the platform.
pub const TILT: Parameter =
    Parameter::angle("tilt", "rotation of the flank against the path", (-0.17, 0.17)).simplest(0.0);

/// Distance along y between the start and an object with a flank.
pub const FLANK_AHEAD: Parameter =
    Parameter::length("ahead", "distance along y between the zero point and the object", (0.05, 0.12));

/// Distances between the start and the nearest point of an object ahead, along the platform's path and across it.
/// Neither nose nor whiskers reach as far ahead from any start. A whisker reaches 127 mm to the side, the body at most
/// 60 mm.
pub const AHEAD: Parameter =
    Parameter::length("ahead", "distance along the path between the start and the object", (0.16, 0.25));
pub const ASIDE: Parameter =
    Parameter::length("aside", "distance across the path between the start and the object", (0.085, 0.115))
        .simplest(0.1);

/// Distance between the start and a tunnel.
pub const MOUTH_AHEAD: Parameter = Parameter::length("ahead", "distance between the start and the mouth", (0.16, 0.2));

/// Clear width of a tunnel.
pub const WIDTH: Parameter =
    Parameter::length("width", "clear width of the tunnel", (0.18, 0.26)).within((0.15, 0.4)).simplest(0.22);

/// Rotation of a polygon's first corner.
pub(super) const fn phase(name: &'static str) -> Parameter {
    Parameter::angle(name, "direction of the first corner", (0.0, 2.0 * PI)).in_steps(PI / 180.0)
}

/// Displacement of a polygon's corner along the circle.
pub(super) const fn shift(name: &'static str) -> Parameter {
    Parameter::share(
        name,
        "displacement of this corner along the circle, as a share of the regular spacing",
        (-0.3, 0.3),
    )
    .simplest(0.0)
}
