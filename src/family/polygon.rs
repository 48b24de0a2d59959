//! Random polygons, their corners sharp or rounded.

use std::f64::consts::TAU;

use super::Family;
use super::layout::{Aim, Layout, REFERENCE, rounded_polygon};
use super::outline::{convex_polygon, rounded, turn};
use super::position::{ahead, beside};
use super::sampler::Sampler;
use crate::geometry::Vector2;

pub(super) const FAMILY: Family = Family {
    name: "polygon",
    about: "a convex polygon of 3 to 8 corners, each sharp or, if the sides are long enough, rounded by 2 to 10 cm",
    lay,
};

/// Largest share of a side that its two rounded corners replace.
const ROUNDED: f64 = 0.8;

fn lay(sampler: &mut Sampler) -> Layout {
    let hand = sampler.side();
    let radius = sampler.between(0.2, 0.35);
    let count = sampler.count(3, 8);
    let corners = convex_polygon(sampler, radius, count);
    // The first corner stays sharp: the outline begins there.
    let radii: Vec<f64> =
        (0..corners.len()).map(|k| if k == 0 { 0.0 } else { rounding(sampler, &corners, k) }).collect();
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

/// The radius (m) of a corner. Every other corner is rounded, the rest have 0.
fn rounding(sampler: &mut Sampler, corners: &[Vector2], k: usize) -> f64 {
    let (into, out, turn) = turn(corners, k);
    let room = 0.5 * ROUNDED * into.norm().min(out.norm()) / (0.5 * turn).tan();
    let wanted = sampler.between(0.02, 0.1);
    if sampler.count(0, 1) == 0 || room < 0.02 { 0.0 } else { wanted.min(room) }
}
