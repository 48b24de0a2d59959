//! The clearance of a rig.

use super::gap::gap;
use crate::geometry::{Contour, Point2, Pose, Segment, unit};
use vibrissa_runtime::rig::Rig;

/// A part of the rig closer to a solid than this (m) touches it.
const TOUCHING: f64 = 1e-5;

/// A part of a rig that overlaps a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Overlap {
    /// The platform.
    Platform,
    /// The undeflected whisker with this index.
    Whisker(usize),
}

/// Returns the first part of the rig at `pose`, with undeflected whiskers, that overlaps or touches the interior of
/// `object`.
pub(crate) fn overlap(rig: &Rig, pose: &Pose, object: &Contour) -> Option<Overlap> {
    let outline_body = rig.platform.outline_body();
    // Most objects of a large scene are out of reach.
    let of_whiskers = rig
        .whiskers
        .iter()
        .map(|whisker| whisker.base_body.coords.norm() + whisker.shaft.length + whisker.shaft.radius);
    let reach = outline_body.iter().map(|corner| corner.coords.norm()).chain(of_whiskers).fold(0.0, f64::max);
    if object.bounding_box().distance(pose.position) > reach + 2.0 * TOUCHING {
        return None;
    }
    let outline = outline_body.map(|corner| pose.point_to_world(corner));
    let sides = (0..4).map(|side| (outline[side], outline[(side + 1) % 4]));
    let swallowed = is_within(&outline, object.point_at(0.0));
    if swallowed || sides.into_iter().any(|(from, to)| !is_clear(object, from, to, TOUCHING)) {
        return Some(Overlap::Platform);
    }
    let hits = rig.whiskers.iter().position(|whisker| {
        let tip_body = whisker.base_body + whisker.shaft.length * unit(whisker.direction_body);
        let (base, tip) = (pose.point_to_world(whisker.base_body), pose.point_to_world(tip_body));
        !is_clear(object, base, tip, whisker.shaft.radius + TOUCHING)
    });
    hits.map(Overlap::Whisker)
}

/// True if every point of a line is outside of the object and farther than `margin` (m) from its outline. A line that
/// does not meet the outline is outside if one of its points is.
fn is_clear(object: &Contour, start: Point2, end: Point2, margin: f64) -> bool {
    let line = Segment { start, end };
    !object.contains(start) && object.pieces_within(&line, margin).all(|piece| gap(&line, piece) > margin)
}

/// True if a point is inside of a convex polygon, given counter-clockwise.
fn is_within(corners: &[Point2; 4], point: Point2) -> bool {
    (0..4).all(|side| (corners[(side + 1) % 4] - corners[side]).perp(&(point - corners[side])) > 0.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::geometry::{circle, polygon};
    use proptest::prelude::*;

    fn disk(x: f64, y: f64, radius: f64) -> Contour {
        circle(Point2::new(x, y), radius).unwrap()
    }

    #[test]
    fn the_reference_start_is_clear_of_the_reference_disk() {
        let start = Pose { position: Point2::new(0.0, 0.072), heading: std::f64::consts::FRAC_PI_2 };
        assert_eq!(overlap(&Rig::default(), &start, &disk(0.4, 0.4, 0.3)), None);
    }

    #[test]
    fn a_platform_inside_an_object_and_an_object_inside_a_platform_overlap() {
        assert_eq!(overlap(&Rig::default(), &Pose::default(), &disk(0.0, 0.0, 1.0)), Some(Overlap::Platform));
        assert_eq!(overlap(&Rig::default(), &Pose::default(), &disk(0.0, 0.0, 0.001)), Some(Overlap::Platform));
    }

    #[test]
    fn a_whisker_that_sticks_into_an_object_is_named() {
        assert_eq!(overlap(&Rig::default(), &Pose::default(), &disk(0.03, 0.13, 0.02)), Some(Overlap::Whisker(1)));
    }

    /// The tail of the platform is parallel to a wall and 10 nm too far away to touch it.
    #[test]
    fn a_side_parallel_to_an_object_is_judged_by_its_gap() {
        let wall =
            polygon(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 0.0), (-1.0, 0.0)].map(|(x, y)| Point2::new(x, y))).unwrap();
        let stands = |gap: f64| {
            let position = Point2::new(0.0, Rig::default().platform.centre_of_mass + gap);
            overlap(&Rig::default(), &Pose { position, heading: std::f64::consts::FRAC_PI_2 }, &wall)
        };
        assert_eq!(stands(TOUCHING + 1e-8), None);
        assert_eq!(stands(TOUCHING - 1e-8), Some(Overlap::Platform));
    }

    proptest! {
        #[test]
        fn a_segment_is_clear_of_a_disk_if_its_nearest_point_is(
            x in -1.0_f64..1.0, y in -1.0_f64..1.0, u in -1.0_f64..1.0, v in -1.0_f64..1.0, radius in 0.05_f64..1.0,
        ) {
            let (from, to) = (Point2::new(x, y), Point2::new(u, v));
            let along = to - from;
            prop_assume!(along.norm() > 1e-3);
            let share = (-from.coords.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            let gap = (from + share * along).coords.norm() - radius;
            prop_assume!((gap - TOUCHING).abs() > 1e-9);
            prop_assert_eq!(is_clear(&disk(0.0, 0.0, radius), from, to, TOUCHING), gap > TOUCHING);
        }
    }
}
