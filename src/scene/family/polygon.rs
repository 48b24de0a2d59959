//! Random polygons, their corners sharp or rounded.

use std::f64::consts::TAU;

use super::Family;
use super::dice::Dice;
use super::layout::{Aim, Contact, Layout, beside, rounded_polygon};
use super::outline::convex_polygon;
use crate::geometry::{Point2, Vector2};

pub(super) const FAMILY: Family = Family {
    name: "polygon",
    about: "a convex polygon of 3 to 8 corners, each sharp or rounded by 2 to 10 cm where there is room",
    lay,
};

/// How much of a side its two rounded corners may take.
const ROUNDED: f64 = 0.8;

fn lay(dice: &mut Dice) -> Layout {
    let hand = dice.side();
    let radius = dice.between(0.2, 0.35);
    let count = dice.count(3, 8);
    let centre = Point2::new(hand * (0.2 + radius), 0.35);
    let corners: Vec<Point2> = convex_polygon(dice, radius, count).iter().map(|&corner| centre + corner).collect();
    let radii: Vec<f64> = (0..corners.len())
        .map(|k| {
            let [before, here, after] = [k + corners.len() - 1, k, k + 1].map(|k| corners[k % corners.len()]);
            let (into, out): (Vector2, Vector2) = (here - before, after - here);
            let turn = into.perp(&out).atan2(into.dot(&out));
            let room = 0.5 * ROUNDED * into.norm().min(out.norm()) / (0.5 * turn).tan();
            let wanted = dice.between(0.02, 0.1);
            // The first stays sharp: the outline begins there.
            if k == 0 || dice.count(0, 1) == 0 || room < 0.02 { 0.0 } else { wanted.min(room) }
        })
        .collect();
    let rounded = radii.iter().filter(|radius| **radius > 0.0).count();
    Layout {
        about: format!("{count} corners, {rounded} of them rounded"),
        objects: vec![rounded_polygon(&corners, &radii)],
        physics: Contact::Sharp,
        start: beside(hand),
        aim: Aim::Loop,
        way: TAU * radius,
    }
}
