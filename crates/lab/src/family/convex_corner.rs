//! A convex corner in the path of a whisker.

use std::f64::consts::{FRAC_PI_2, PI};

use super::layout::{self, Aim, Layout, REFERENCE, polygon};
use super::position::{along, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::{SIDE, TILT};
use vibrissa_declare::catalogue::convex_corner::{ANGLE, ROOF, THICKNESS, WALL};
use vibrissa_world::geometry::{Vector2, convex_corner, rotate};

/// Corners that turn by more than this (rad) are blades: two corners that turn by 180° in sum.
const BLADE: f64 = 172.0 / 180.0 * PI;

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let turn = sampler.number(&ANGLE);
    let (side, back, thickness) = (sampler.number(&ROOF), sampler.number(&WALL), sampler.number(&THICKNESS));
    // The side before the corner is parallel to the path of the platform, with the corner ahead.
    let tilt = if turn > BLADE { 0.0 } else { 0.5 * (PI - turn) } + sampler.number(&TILT);
    let shape = if turn > BLADE { blade(side, thickness).to_vec() } else { convex_corner(turn, side, back).to_vec() };
    let corners: Vec<_> = shape.iter().map(|&corner| rotate(corner, FRAC_PI_2 + tilt)).collect();
    let hand = sampler.side(&SIDE);
    let corners = along(sampler, hand, &corners, &corners);
    let object = if turn > BLADE {
        polygon(&corners)
    } else {
        layout::convex_corner(corners[0], FRAC_PI_2 + hand * tilt, turn, side, back)
    };
    Layout {
        about: format!("a corner that turns by {:.1}°", turn.to_degrees()),
        objects: vec![object],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: 2.0 * (side + back) + 0.5,
        rig: REFERENCE,
    }
}

/// The corners of a plate of this length and thickness (m) relative to a corner at its end. The plate points along x.
fn blade(length: f64, thickness: f64) -> [Vector2; 4] {
    let (across, down) = (Vector2::new(0.0, -thickness), Vector2::new(-length, 0.0));
    [Vector2::zeros(), down, down + across, across]
}
