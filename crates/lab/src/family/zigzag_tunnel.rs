//! Tunnels of straight sections with corners of alternating sign.

use super::layout::{Aim, Layout, REFERENCE, tunnel};
use super::position::{before, mouth};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::WIDTH;
use vibrissa_declare::catalogue::zigzag_tunnel::{ANGLE, LENGTH, SECTIONS, SIDE};

const THICKNESS: f64 = 0.02;

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let turn = sampler.number(&ANGLE);
    let clear = sampler.number(&WIDTH);
    let (length, hand) = (sampler.number(&LENGTH), sampler.side(&SIDE));
    // The first section is straight ahead.
    let runs: Vec<_> =
        (0..sampler.whole(&SECTIONS)).map(|run| (length, if run % 2 == 0 { 0.0 } else { hand * turn })).collect();
    let from = mouth(sampler);
    Layout {
        about: format!("turns of {:.1}°, {:.0} mm clear", turn.to_degrees(), 1e3 * clear),
        objects: vec![tunnel(&from, &runs, clear, THICKNESS)],
        start: before(),
        aim: Aim::Through,
        path_length: runs.iter().map(|run| run.0).sum(),
        rig: REFERENCE,
    }
}
