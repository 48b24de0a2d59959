//! Where starts are, and where objects go so that they lie in a whisker's way.
//!
//! Starts vary by 40 mm and 30°. Objects keep so far away from all of them that the rig stands clear and none need be drawn again.

use std::f64::consts::FRAC_PI_2;

use super::dice::Dice;
use crate::geometry::{Point2, Pose, Vector2, perpendicular, unit};

/// Where the platform's centre of mass is at the start that others are near (m), as in the thesis.
const START: Point2 = Point2::new(0.0, 0.072);

/// How far the start beside an object is turned towards it (rad).
const INCLINATION: f64 = 0.35;

/// How far sideways (m) from the start a flank begins that goes the platform's way.
const ASIDE: f64 = 0.19;

/// How far (m) the nearest point of an object that lies ahead is from the start, along the platform's way: farther than the nose
/// and the whiskers reach from where starts may be.
const AHEAD: (f64, f64) = (0.16, 0.25);

/// How far (m) sideways from the way of the platform's centre of mass the object reaches up to it: a whisker reaches 127 mm out,
/// the body at most 60 mm.
const GAP: (f64, f64) = (0.085, 0.115);

/// The start before a tunnel.
pub(super) fn before() -> Pose {
    Pose { position: START, heading: FRAC_PI_2 }
}

/// The start beside an object to the right or left (`hand` +1 or −1), turned a little towards it.
pub(super) fn beside(hand: f64) -> Pose {
    Pose { position: START, heading: FRAC_PI_2 - hand * INCLINATION }
}

/// Moves an object whose `flank` (some of its corners) goes up along the platform's way on the right, to where the platform comes
/// upon that; or to its mirror image on the left.
pub(super) fn along(dice: &mut Dice, hand: f64, corners: &[Vector2], flank: &[Vector2]) -> Vec<Point2> {
    let lowest = corners.iter().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
    let nearest = flank.iter().map(|corner| corner.x).fold(f64::INFINITY, f64::min);
    let to = Vector2::new(ASIDE - nearest, dice.between(0.05, 0.12) - lowest);
    corners.iter().map(|corner| Point2::new(hand * (corner.x + to.x), corner.y + to.y)).collect()
}

/// Where the origin of an object on the right or left goes, given by points of its outline, so that straight ahead from the start
/// beside it a whisker meets it, and the body would pass.
pub(super) fn ahead(dice: &mut Dice, hand: f64, outline: &[Vector2]) -> Point2 {
    let forward = unit(beside(hand).heading);
    let aside = -hand * perpendicular(forward);
    let least = |direction: Vector2| outline.iter().map(|point| direction.dot(point)).fold(f64::INFINITY, f64::min);
    let ahead = dice.between(AHEAD.0, AHEAD.1) - least(forward);
    START + ahead * forward + (dice.between(GAP.0, GAP.1) - least(aside)) * aside
}

/// Where a tunnel begins before the start, and its direction there.
pub(super) fn mouth(dice: &mut Dice) -> Pose {
    Pose { position: Point2::new(0.0, START.y + AHEAD.0 + dice.between(0.0, 0.04)), heading: FRAC_PI_2 }
}
