//! The entrance of a tunnel.

use super::Family;
use super::layout::{Aim, Layout, REFERENCE, tunnel};
use super::position::{before, mouth};
use super::sampler::Sampler;
use crate::geometry::unit;

pub(super) const FAMILY: Family = Family {
    name: "tunnel-mouth",
    about: "a straight tunnel with a free width of 18 to 26 cm and walls of 5 to 40 mm",
    lay,
};

fn lay(sampler: &mut Sampler) -> Layout {
    let (clear, thickness) = (sampler.between(0.18, 0.26), sampler.between(5e-3, 0.04));
    let (length, from) = (sampler.between(0.5, 0.9), mouth(sampler));
    Layout {
        about: format!("{:.0} mm clear, walls of {:.0} mm", 1e3 * clear, 1e3 * thickness),
        objects: vec![tunnel(&from, &[(length, 0.0)], clear, thickness)],
        start: before(),
        aim: Aim::Through(from.position + length * unit(from.heading)),
        path_length: length,
        rig: REFERENCE,
    }
}
