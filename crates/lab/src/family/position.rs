//! Positions of starts, and of objects in the path of a whisker.
//!
//! Starts deviate by at most 40 mm and 30°. Objects have such distances from all starts that the rig is always
//! collision-free. Therefore no start is rejected.

use std::f64::consts::FRAC_PI_2;

use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::{AHEAD, ASIDE, FLANK_AHEAD, MOUTH_AHEAD};
use vibrissa_world::geometry::{Point2, Pose, Vector2, perpendicular, unit};

/// Position of the platform's centre of mass at the mean start (m), as in the baseline's scenes.
const START: Point2 = Point2::new(0.0, 0.072);

/// Rotation of the start beside an object towards the object (rad).
const INCLINATION: f64 = 0.35;

/// Lateral distance (m) between the start and a flank that is parallel to the platform's path.
const FLANK_ASIDE: f64 = 0.19;

/// The start in front of a tunnel.
pub(super) fn before() -> Pose {
    Pose { position: START, heading: FRAC_PI_2 }
}

/// The start beside an object to the right or left (`hand` +1 or −1), rotated slightly towards it.
pub(super) fn beside(hand: f64) -> Pose {
    Pose { position: START, heading: FRAC_PI_2 - hand * INCLINATION }
}

/// Moves an object on the right to where the platform meets its `flank`, corners of a side parallel to the platform's
/// path. For the left, the result is the mirror image.
pub(super) fn along(sampler: &mut Sampler<'_>, hand: f64, corners: &[Vector2], flank: &[Vector2]) -> Vec<Point2> {
    let lowest = corners.iter().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
    let nearest = flank.iter().map(|corner| corner.x).fold(f64::INFINITY, f64::min);
    let to = Vector2::new(FLANK_ASIDE - nearest, sampler.number(&FLANK_AHEAD) - lowest);
    corners.iter().map(|corner| Point2::new(hand * (corner.x + to.x), corner.y + to.y)).collect()
}

/// The position of the origin of an object on the right or left, given by points of its outline. Straight ahead from
/// the start beside it, a whisker touches it and the body does not.
pub(super) fn ahead(sampler: &mut Sampler<'_>, hand: f64, outline: &[Vector2]) -> Point2 {
    let forward = unit(beside(hand).heading);
    let aside = -hand * perpendicular(forward);
    let least = |direction: Vector2| outline.iter().map(|point| direction.dot(point)).fold(f64::INFINITY, f64::min);
    let ahead = sampler.number(&AHEAD) - least(forward);
    START + ahead * forward + (sampler.number(&ASIDE) - least(aside)) * aside
}

/// The mouth of a tunnel in front of the start, and its direction.
pub(super) fn mouth(sampler: &mut Sampler<'_>) -> Pose {
    Pose { position: Point2::new(0.0, START.y + sampler.number(&MOUTH_AHEAD)), heading: FRAC_PI_2 }
}
