//! Free-standing thin walls.

use super::Family;
use super::layout::{Aim, Layout, REFERENCE, polygon};
use super::position::{along, beside};
use super::sampler::Sampler;
use crate::geometry::{Vector2, rotate};

pub(super) const FAMILY: Family =
    Family { name: "thin-wall", about: "a free-standing straight wall, 2 to 20 mm thick", lay };

fn lay(sampler: &mut Sampler) -> Layout {
    let (length, thickness) = (sampler.between(0.3, 0.6), sampler.between(2e-3, 0.02));
    let (hand, tilt) = (sampler.side(), sampler.between(-0.17, 0.17));
    let (across, down) = (Vector2::new(thickness, 0.0), Vector2::new(0.0, -length));
    let corners = [Vector2::zeros(), down, down + across, across].map(|corner| rotate(corner, tilt));
    Layout {
        about: format!("{:.0} mm long, {:.1} mm thick", 1e3 * length, 1e3 * thickness),
        objects: vec![polygon(&along(sampler, hand, &corners, &corners))],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: 2.0 * (length + thickness) + 0.8,
        rig: REFERENCE,
    }
}
