//! Two objects side by side.

use std::f64::consts::TAU;

use super::Family;
use super::layout::{Aim, FORWARD_FACING, Layout, circle, polygon};
use super::outline::{convex_polygon, disk};
use super::position::{ahead, beside};
use super::sampler::Sampler;
use crate::geometry::{Vector2, unit};

pub(super) const FAMILY: Family =
    Family { name: "two-objects", about: "two disks or polygons side by side, 5 to 60 cm apart", lay };

fn lay(sampler: &mut Sampler) -> Layout {
    let hand = sampler.side();
    let radii = [sampler.between(0.14, 0.2), sampler.between(0.1, 0.2)];
    let gap = sampler.between(0.05, 0.6);
    let corners: [Vec<Vector2>; 2] = radii.map(|radius| match sampler.count(2, 6) {
        2 => Vec::new(),
        sides => convex_polygon(sampler, radius, sides),
    });
    // A disk has no corners.
    let centre = ahead(sampler, hand, &if corners[0].is_empty() { disk(radii[0]) } else { corners[0].clone() });
    // The second one is farther to the side, or behind the first: the platform meets the first one first.
    let direction = unit(sampler.between(-0.3, 1.3));
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
