//! Thin walls that stand free.

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Contact, Layout, beside, polygon};
use crate::geometry::{Point2, Vector2, rotate};

pub(super) const FAMILY: Family =
    Family { name: "thin-wall", about: "a straight wall, 2 to 20 mm thick, that stands free", lay };

fn lay(dice: &mut Dice) -> Layout {
    let (length, thickness) = (dice.between(0.25, 0.6), dice.between(2e-3, 0.02));
    let (hand, tilt) = (dice.side(), dice.between(-0.26, 0.26));
    let end = Point2::new(0.2, dice.between(0.4, 0.5));
    let corners =
        [Vector2::zeros(), Vector2::new(0.0, -length), Vector2::new(thickness, -length), Vector2::new(thickness, 0.0)];
    let placed = corners.map(|place| {
        let place = end + rotate(place, tilt);
        Point2::new(hand * place.x, place.y)
    });
    Layout {
        about: format!("{:.0} mm long, {:.1} mm thick", 1e3 * length, 1e3 * thickness),
        objects: vec![polygon(&placed)],
        physics: Contact::Sharp,
        start: beside(hand),
        aim: Aim::Loop,
        way: 2.0 * (length + thickness) + 0.8,
    }
}
