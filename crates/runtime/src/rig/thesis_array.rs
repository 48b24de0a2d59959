//! The array of the thesis that the baseline program belongs to.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point2;

use super::{Platform, Rig, Sensing, Shaft, Whisker};
use crate::math;

/// Slope of the sides of the body (rad), half of the angle of its nose. Whiskers are perpendicular to the sides, so it
/// is also the angle by which they point forward.
const SLOPE: f64 = std::f64::consts::PI / 12.0;
/// Width at the tail (m).
const TAIL_WIDTH: f64 = 0.060;
/// Length from tail to nose (m).
const LENGTH: f64 = 0.090;
/// Distance of the centroid ahead of the tail (m).
const CENTROID: f64 = 0.035;
/// Positions of the bases ahead of the centroid (m), from the front to the back.
const BASES: [f64; 3] = [0.025, 0.005, -0.015];
/// Distance of a base from the side of the body (m), across the heading.
const OFF_SIDE: f64 = 1e-3;
/// Length of a whisker (m).
const WHISKER_LENGTH: f64 = 0.075;

impl Rig {
    /// The array of the thesis (sections 1.4.7, 3.1 and 3.2): a body with a nose of 30° and three whiskers per side,
    /// which point forward by 15°. They are `r0`, `r1`, `r2` and `l0`, `l1`, `l2` from the front to the back.
    ///
    /// The text has no position of a base and no mass. The bases are 20 mm apart, because the boards of the sensors are
    /// 17.8 mm wide. Mass, inertia and servos are those of the reference platform, because a robot arm carries the array.
    #[must_use]
    pub fn thesis_array() -> Self {
        let side_at = |ahead: f64| 0.5 * TAIL_WIDTH - (ahead + CENTROID) * math::tan(SLOPE);
        let platform = Platform {
            tail_width: TAIL_WIDTH,
            nose_width: 2.0 * side_at(LENGTH - CENTROID),
            length: LENGTH,
            centre_of_mass: CENTROID,
            ..Platform::default()
        };
        let whisker = |letter: char, side: f64, (index, ahead): (usize, f64)| Whisker {
            base_body: Point2::new(ahead, side * (side_at(ahead) + OFF_SIDE)),
            direction_body: side * (FRAC_PI_2 - SLOPE),
            shaft: Shaft { length: WHISKER_LENGTH, ..Shaft::default() },
            ..Whisker::reference(&format!("{letter}{index}"), side)
        };
        let row = |letter, side| BASES.into_iter().enumerate().map(move |place| whisker(letter, side, place));
        Self { platform, whiskers: row('r', -1.0).chain(row('l', 1.0)).collect(), sensing: Sensing::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_nose_has_30_degrees_and_its_whiskers_are_perpendicular_to_the_sides() {
        let rig = Rig::thesis_array();
        let [tail, nose, ..] = rig.platform.outline_body();
        let side = nose - tail;
        assert!((math::atan2(side.y, side.x).to_degrees() - 15.0).abs() < 1e-9);
        for whisker in &rig.whiskers {
            let side = Point2::new(side.x, -whisker.side() * side.y).coords;
            let along = math::cos(whisker.direction_body) * side.x + math::sin(whisker.direction_body) * side.y;
            assert!(along.abs() < 1e-12, "{}", whisker.name);
            assert!((whisker.direction_body.abs().to_degrees() - 75.0).abs() < 1e-9);
        }
    }

    #[test]
    fn its_centre_of_mass_is_the_centroid_of_the_body() {
        let Platform { tail_width, nose_width, length, centre_of_mass, .. } = Rig::thesis_array().platform;
        let centroid = length / 3.0 * (tail_width + 2.0 * nose_width) / (tail_width + nose_width);
        assert!((centroid - centre_of_mass).abs() < 0.2e-3, "{centroid}");
    }
}
