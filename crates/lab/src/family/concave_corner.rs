//! A concave corner.

use std::f64::consts::FRAC_PI_2;

use super::layout::{self, Aim, FORWARD_FACING, Layout};
use super::position::{along, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::{SIDE, TILT};
use vibrissa_declare::catalogue::concave_corner::{ANGLE, FIRST, SECOND, THICKNESS};
use vibrissa_world::geometry::{concave_corner, rotate};

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let turn = sampler.number(&ANGLE);
    let hand = sampler.side(&SIDE);
    let tilt = sampler.number(&TILT);
    let (first, second) = (sampler.number(&FIRST), sampler.number(&SECOND));
    let thickness = sampler.number(&THICKNESS);
    // Along the first side to the corner, and from there towards the platform.
    let corners = concave_corner(turn, first, second, thickness).map(|corner| rotate(corner, FRAC_PI_2 + tilt));
    let flank = [corners[0], corners[5]];
    let corner = along(sampler, hand, &corners, &flank)[0];
    let object = layout::concave_corner(corner, FRAC_PI_2 + hand * tilt, hand * turn, [first, second, thickness]);
    Layout {
        about: format!("an inner corner that turns by {:.1}°", turn.to_degrees()),
        objects: vec![object],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: 2.0 * (first + second + thickness),
        rig: FORWARD_FACING,
    }
}
