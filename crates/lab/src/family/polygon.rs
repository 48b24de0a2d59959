//! Random polygons, their corners sharp or rounded.

use std::f64::consts::TAU;

use super::layout::{Aim, Layout, REFERENCE, rounded_polygon};
use super::outline::{convex_polygon, rounded, turn};
use super::position::{ahead, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::Parameter;
use vibrissa_declare::catalogue::common::SIDE;
use vibrissa_declare::catalogue::polygon::{CORNERS, PHASE, RADIUS, ROUNDINGS, SHIFTS};
use vibrissa_runtime::math;
use vibrissa_world::geometry::Vector2;

/// Largest share of a side that its two rounded corners replace.
const ROUNDED: f64 = 0.8;

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let hand = sampler.side(&SIDE);
    let radius = sampler.number(&RADIUS);
    let count = sampler.whole(&CORNERS);
    let corners = convex_polygon(sampler, radius, count, &PHASE, &SHIFTS);
    // The first corner stays sharp: the outline begins there.
    let others = (1..corners.len()).zip(&ROUNDINGS).map(|(k, parameter)| rounding(sampler, &corners, k, parameter));
    let radii: Vec<f64> = std::iter::once(0.0).chain(others).collect();
    let centre = ahead(sampler, hand, &rounded(&corners, &radii));
    let arcs = radii.iter().filter(|radius| **radius > 0.0).count();
    Layout {
        about: format!("{count} corners, {arcs} of them rounded"),
        objects: vec![rounded_polygon(&corners, &radii, centre)],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: TAU * radius,
        rig: REFERENCE,
    }
}

/// The radius (m) of a corner. Of random corners every other one is rounded, the rest have 0.
fn rounding(sampler: &mut Sampler<'_>, corners: &[Vector2], k: usize, parameter: &Parameter) -> f64 {
    let (into, out, turn) = turn(corners, k);
    let room = 0.5 * ROUNDED * into.norm().min(out.norm()) / math::tan(0.5 * turn);
    let wanted = sampler.number_or(parameter, |sampler| {
        let radius = sampler.between(0.02, 0.1);
        if sampler.count(0, 1) == 0 { 0.0 } else { radius }
    });
    if room < 0.02 { 0.0 } else { wanted.min(room) }
}
