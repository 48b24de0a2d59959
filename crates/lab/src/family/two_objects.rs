//! Two objects side by side.

use std::f64::consts::TAU;

use super::layout::{Aim, FORWARD_FACING, Layout, circle, polygon};
use super::outline::{convex_polygon, disk};
use super::position::{ahead, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::SIDE;
use vibrissa_declare::catalogue::two_objects::{DIRECTION, FIRST, GAP, ObjectParameters, SECOND};
use vibrissa_world::geometry::{Vector2, unit};

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let hand = sampler.side(&SIDE);
    let radii = [FIRST.radius, SECOND.radius].map(|radius| sampler.number(&radius));
    let gap = sampler.number(&GAP);
    let corners = [(FIRST, radii[0]), (SECOND, radii[1])].map(|(object, radius)| {
        let ObjectParameters { corners, phase, shifts, .. } = object;
        match sampler.whole(&corners) {
            2 => Vec::new(),
            corners => convex_polygon(sampler, radius, corners, &phase, &shifts),
        }
    });
    // A disk has no corners.
    let centre = ahead(sampler, hand, &if corners[0].is_empty() { disk(radii[0]) } else { corners[0].clone() });
    // The second one is farther to the side, or behind the first: the platform meets the first one first.
    let direction = unit(sampler.number(&DIRECTION));
    let beyond = centre + (radii[0] + gap + radii[1]) * Vector2::new(hand * direction.x, direction.y);
    let object = |corners: &[Vector2], centre, radius| {
        if corners.is_empty() {
            return circle(centre, radius);
        }
        polygon(&corners.iter().map(|corner| centre + corner).collect::<Vec<_>>())
    };
    Layout {
        about: format!("{:.0} mm between the circles around them", 1e3 * gap),
        objects: vec![object(&corners[0], centre, radii[0]), object(&corners[1], beyond, radii[1])],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: TAU * (radii[0] + radii[1]),
        rig: FORWARD_FACING,
    }
}
