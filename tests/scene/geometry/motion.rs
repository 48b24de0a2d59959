//! Moving a contour changes nothing about it.

use proptest::prelude::*;

use crate::geometry::oracle::ROUNDING;
use crate::geometry::random;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn distances_move_with_the_contour(
        (contour, point) in random::with_point(random::any_contour()),
        pose in random::pose(),
    ) {
        let (moved, there) = (contour.transformed(&pose), pose.point_to_world(point));
        let (before, after) = (contour.signed_distance(point), moved.signed_distance(there));
        // On the line on from an open end the two sides meet, so only the size is the same there.
        let size_only = !contour.is_closed() && (before + after).abs() < ROUNDING;
        prop_assert!((before - after).abs() < ROUNDING || size_only, "{before} {after}");
    }

    #[test]
    fn lengths_areas_and_turns_stay(contour in random::any_contour(), pose in random::pose(), share in 0.0..1.0_f64) {
        let moved = contour.transformed(&pose);
        prop_assert!((moved.length() - contour.length()).abs() < ROUNDING);
        prop_assert!((moved.area() - contour.area()).abs() < 1e-12);
        prop_assert_eq!(moved.is_convex(), contour.is_convex());
        let s = share * contour.length();
        prop_assert!((moved.point_at(s) - pose.point_to_world(contour.point_at(s))).norm() < ROUNDING);
        for (corner, twin) in contour.corners().iter().zip(moved.corners()) {
            prop_assert!((corner.turn - twin.turn).abs() < 1e-9);
            prop_assert!((pose.point_to_world(corner.point) - twin.point).norm() < ROUNDING);
        }
    }

    #[test]
    fn poses_undo_themselves(pose in random::pose(), point in random::point(2.0)) {
        prop_assert!((pose.point_from_world(pose.point_to_world(point)) - point).norm() < ROUNDING);
        prop_assert!((pose.vector_to_world(point.coords).norm() - point.coords.norm()).abs() < ROUNDING);
    }
}
