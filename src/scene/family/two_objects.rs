//! Two objects side by side.

use std::f64::consts::TAU;

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Contact, Layout, beside, circle, polygon};
use super::outline::convex_polygon;
use crate::geometry::{Point2, Vector2, unit};

pub(super) const FAMILY: Family =
    Family { name: "two-objects", about: "two disks or polygons, one behind the other, 5 to 60 cm apart", lay };

fn lay(dice: &mut Dice) -> Layout {
    let hand = dice.side();
    let (first, second) = (dice.between(0.14, 0.2), dice.between(0.1, 0.2));
    let gap = dice.between(0.05, 0.6);
    let centre = Point2::new(0.2 + first, 0.3);
    // The second one beyond the first, so that the platform is met by that one first.
    let direction = unit(dice.between(-0.3, 1.3));
    let beyond = centre + (first + gap + second) * direction;
    let placed = |centre: Point2| Point2::new(hand * centre.x, centre.y);
    let objects = [(centre, first), (beyond, second)].map(|(centre, radius)| {
        let sides = dice.count(2, 6);
        if sides == 2 {
            return circle(placed(centre), radius);
        }
        let corners: Vec<Vector2> = convex_polygon(dice, radius, sides);
        polygon(&corners.iter().map(|&corner| placed(centre) + corner).collect::<Vec<_>>())
    });
    Layout {
        about: format!("{:.0} mm apart at least", 1e3 * gap),
        objects: objects.to_vec(),
        physics: Contact::Sharp,
        start: beside(hand),
        aim: Aim::Loop,
        way: TAU * (first + second),
    }
}
