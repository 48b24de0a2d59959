//! Corners round a centre.

use std::f64::consts::TAU;

use super::dice::Dice;
use crate::geometry::{Vector2, unit};

/// The corners of a random convex polygon round the origin: on a circle, no two near each other.
pub(super) fn convex_polygon(dice: &mut Dice, radius: f64, corners: u32) -> Vec<Vector2> {
    let (turned, step) = (dice.between(0.0, TAU), TAU / f64::from(corners));
    let angle = |k: u32, dice: &mut Dice| turned + step * (f64::from(k) + dice.between(-0.3, 0.3));
    (0..corners).map(|k| radius * unit(angle(k, dice))).collect()
}
