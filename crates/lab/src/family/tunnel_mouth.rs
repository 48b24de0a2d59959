//! The entrance of a tunnel.

use super::layout::{Aim, Layout, REFERENCE, tunnel};
use super::position::{before, mouth};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::WIDTH;
use vibrissa_declare::catalogue::tunnel_mouth::{LENGTH, THICKNESS};

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let (clear, thickness) = (sampler.number(&WIDTH), sampler.number(&THICKNESS));
    let (length, from) = (sampler.number(&LENGTH), mouth(sampler));
    Layout {
        about: format!("{:.0} mm clear, walls of {:.0} mm", 1e3 * clear, 1e3 * thickness),
        objects: vec![tunnel(&from, &[(length, 0.0)], clear, thickness)],
        start: before(),
        aim: Aim::Through,
        path_length: length,
        rig: REFERENCE,
    }
}
