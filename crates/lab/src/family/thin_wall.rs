//! Free-standing thin walls.

use super::layout::{Aim, Layout, REFERENCE, polygon};
use super::position::{along, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::{SIDE, TILT};
use vibrissa_declare::catalogue::thin_wall::{LENGTH, THICKNESS};
use vibrissa_world::geometry::{Vector2, rotate};

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let (length, thickness) = (sampler.number(&LENGTH), sampler.number(&THICKNESS));
    let (hand, tilt) = (sampler.side(&SIDE), sampler.number(&TILT));
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
