//! A convex corner in the path of a whisker.

use std::f64::consts::PI;

use super::Family;
use super::layout::{Aim, Layout, REFERENCE, polygon};
use super::position::{along, beside};
use super::sampler::Sampler;
use crate::geometry::{Vector2, rotate};

pub(super) const FAMILY: Family = Family {
    name: "convex-corner",
    about: "a convex corner that turns by 30° to 180°: houses with flat and steep gables, wedges, blades",
    lay,
};

/// Corners that turn by more than this (rad) are blades: two corners that turn by 180° in sum.
const BLADE: f64 = 172.0 / 180.0 * PI;

fn lay(sampler: &mut Sampler) -> Layout {
    let turn = sampler.between(PI / 6.0, PI);
    let (side, back, thickness) = (sampler.between(0.25, 0.4), sampler.between(0.1, 0.25), sampler.between(2e-3, 5e-3));
    let corners = if turn > BLADE { blade(side, thickness) } else { house(turn, side, back) };
    // The side before the corner is parallel to the path of the platform, with the corner ahead.
    let tilt = if turn > BLADE { 0.0 } else { 0.5 * (PI - turn) } + sampler.between(-0.17, 0.17);
    let corners: Vec<_> = corners.iter().map(|&corner| rotate(corner, tilt)).collect();
    let hand = sampler.side();
    Layout {
        about: format!("a corner that turns by {:.1}°", turn.to_degrees()),
        objects: vec![polygon(&along(sampler, hand, &corners, &corners))],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: 2.0 * (side + back) + 0.5,
        rig: REFERENCE,
    }
}

/// The corners of a house relative to the top of its gable, which turns by `turn` (rad) and points along y. The roofs
/// have a length of `side` (m), the walls of `back` (m).
fn house(turn: f64, side: f64, back: f64) -> Vec<Vector2> {
    let half = 0.5 * (PI - turn);
    let (width, height) = (side * half.sin(), side * half.cos());
    let wall = Vector2::new(0.0, -back);
    let (left, right) = (Vector2::new(-width, -height), Vector2::new(width, -height));
    vec![Vector2::zeros(), left, left + wall, right + wall, right]
}

/// The corners of a plate of this length and thickness (m) relative to a corner at its end. The plate points along y.
fn blade(length: f64, thickness: f64) -> Vec<Vector2> {
    let (across, down) = (Vector2::new(thickness, 0.0), Vector2::new(0.0, -length));
    vec![Vector2::zeros(), down, down + across, across]
}
