//! A concave corner.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Family;
use super::layout::{Aim, FORWARD_FACING, Layout, polygon};
use super::position::{along, beside};
use super::sampler::Sampler;
use crate::geometry::{Vector2, perpendicular, unit};

pub(super) const FAMILY: Family =
    Family { name: "concave-corner", about: "an L-shaped bar with an inner corner of 15° to 75°", lay };

fn lay(sampler: &mut Sampler) -> Layout {
    let turn = sampler.between(15.0, 75.0) / 180.0 * PI;
    let hand = sampler.side();
    let tilt = sampler.between(-0.17, 0.17);
    let (first, second) = (sampler.between(0.4, 0.55), sampler.between(0.25, 0.4));
    let thickness = sampler.between(0.15, 0.25);
    // Along the first side to the corner, and from there towards the platform.
    let (into, out) = (unit(FRAC_PI_2 + tilt), unit(FRAC_PI_2 + tilt + turn));
    let right = |along: Vector2| -thickness * perpendicular(along);
    let corners = [
        Vector2::zeros(),
        second * out,
        second * out + right(out),
        thickness * displaced_corner(into, out),
        right(into) - first * into,
        -first * into,
    ];
    let flank = [Vector2::zeros(), -first * into];
    Layout {
        about: format!("an inner corner that turns by {:.1}°", turn.to_degrees()),
        objects: vec![polygon(&along(sampler, hand, &corners, &flank))],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: 2.0 * (first + second + thickness),
        rig: FORWARD_FACING,
    }
}

/// The vector from the corner between two directions to the corner of their lines displaced by a metre to the right.
fn displaced_corner(into: Vector2, out: Vector2) -> Vector2 {
    let (before, after) = (-perpendicular(into), -perpendicular(out));
    (before + after) / (1.0 + before.dot(&after))
}
