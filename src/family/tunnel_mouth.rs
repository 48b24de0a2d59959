//! The entrance of a tunnel.

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Layout, REFERENCE, tunnel};
use super::place::{before, mouth};
use crate::geometry::unit;

pub(super) const FAMILY: Family =
    Family { name: "tunnel-mouth", about: "a straight tunnel, 18 to 26 cm clear, between walls of 5 to 40 mm", lay };

fn lay(dice: &mut Dice) -> Layout {
    let (clear, thickness) = (dice.between(0.18, 0.26), dice.between(5e-3, 0.04));
    let (length, from) = (dice.between(0.5, 0.9), mouth(dice));
    Layout {
        about: format!("{:.0} mm clear, walls of {:.0} mm", 1e3 * clear, 1e3 * thickness),
        objects: vec![tunnel(&from, &[(length, 0.0)], clear, thickness)],
        start: before(),
        aim: Aim::Through(from.position + length * unit(from.heading)),
        way: length,
        rig: REFERENCE,
    }
}
