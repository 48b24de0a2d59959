//! Tunnels of straight sections with corners of alternating sign.

use std::f64::consts::PI;

use super::Family;
use super::layout::{Aim, Layout, REFERENCE, tunnel};
use super::position::{before, mouth};
use super::sampler::Sampler;
use crate::geometry::{Vector2, unit};

pub(super) const FAMILY: Family = Family {
    name: "zigzag-tunnel",
    about: "a tunnel of straight runs with alternating turns of 10° to 60°, and a free width of 18 to 26 cm",
    lay,
};

const THICKNESS: f64 = 0.02;

fn lay(sampler: &mut Sampler) -> Layout {
    let turn = sampler.between(10.0, 60.0) / 180.0 * PI;
    let clear = sampler.between(0.18, 0.26);
    let (length, hand) = (sampler.between(0.22, 0.35), sampler.side());
    // The first section is straight ahead.
    let runs: Vec<_> =
        (0..sampler.count(4, 6)).map(|run| (length, if run % 2 == 0 { 0.0 } else { hand * turn })).collect();
    let from = mouth(sampler);
    let along: Vector2 = runs.iter().map(|&(length, heading)| length * unit(from.heading + heading)).sum();
    Layout {
        about: format!("turns of {:.1}°, {:.0} mm clear", turn.to_degrees(), 1e3 * clear),
        objects: vec![tunnel(&from, &runs, clear, THICKNESS)],
        start: before(),
        aim: Aim::Through(from.position + along),
        path_length: runs.iter().map(|run| run.0).sum(),
        rig: REFERENCE,
    }
}
