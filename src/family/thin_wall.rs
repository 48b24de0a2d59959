//! Free-standing thin walls.

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Layout, REFERENCE, polygon};
use super::place::{along, beside};
use crate::geometry::{Vector2, rotate};

pub(super) const FAMILY: Family =
    Family { name: "thin-wall", about: "a straight wall, 2 to 20 mm thick, that stands free", lay };

fn lay(dice: &mut Dice) -> Layout {
    let (length, thickness) = (dice.between(0.3, 0.6), dice.between(2e-3, 0.02));
    let (hand, tilt) = (dice.side(), dice.between(-0.17, 0.17));
    let (across, down) = (Vector2::new(thickness, 0.0), Vector2::new(0.0, -length));
    let corners = [Vector2::zeros(), down, down + across, across].map(|corner| rotate(corner, tilt));
    Layout {
        about: format!("{:.0} mm long, {:.1} mm thick", 1e3 * length, 1e3 * thickness),
        objects: vec![polygon(&along(dice, hand, &corners, &corners))],
        start: beside(hand),
        aim: Aim::Loop,
        way: 2.0 * (length + thickness) + 0.8,
        rig: REFERENCE,
    }
}
