//! Several contours as one, and whether two overlap.

use proptest::prelude::*;
use vibrissa::geometry::{Contour, ContourSet, Point2, Pose, circle};

use crate::geometry::random;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn the_nearest_point_of_a_set_is_that_of_its_nearest_contour(
        contours in prop::collection::vec(random::any_contour(), 1..6), point in random::point(2.0),
    ) {
        let set = ContourSet::new(contours.clone()).unwrap();
        let nearest = set.nearest(point);
        let least = contours.iter().map(|contour| contour.nearest(point).distance).fold(f64::INFINITY, f64::min);
        prop_assert!((nearest.distance - least).abs() < 1e-15);
        prop_assert!((nearest.point - point).norm() - least < 1e-9);
        prop_assert_eq!(set.distance(point).to_bits(), nearest.distance.to_bits());
        let length: f64 = contours.iter().map(Contour::length).sum();
        prop_assert!((set.length() - length).abs() < 1e-12 && nearest.arc_length <= length);
    }

    #[test]
    fn contours_overlap_where_one_has_a_point_inside_the_other(
        a in random::closed(), b in random::closed(), x in -1.0..1.0_f64, y in -1.0..1.0_f64,
    ) {
        let b = b.transformed(&Pose { position: Point2::new(x, y), heading: 0.0 });
        let inside = a.sample(0.01).iter().any(|sample| b.contains(sample.point))
            || b.sample(0.01).iter().any(|sample| a.contains(sample.point));
        let apart = a.sample(0.002).iter().map(|sample| b.nearest(sample.point).distance).fold(f64::INFINITY, f64::min);
        prop_assert_eq!(a.overlaps(&b), b.overlaps(&a));
        prop_assert!(a.overlaps(&b) || !inside);
        prop_assert!(!a.overlaps(&b) || inside || apart < 0.01);
    }
}

#[test]
fn there_is_no_set_of_nothing() {
    assert!(ContourSet::new([]).is_none());
    assert!(ContourSet::new([circle(Point2::origin(), 0.1).unwrap()]).is_some());
}
