//! Nearest points and signed distances.

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Piece, Point2, Pose, circle, unit};

use crate::geometry::oracle::{self, ROUNDING};
use crate::geometry::random;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn the_nearest_point_is_as_near_as_that_of_the_nearest_piece(
        (contour, point) in random::with_point(random::any_contour()),
    ) {
        let nearest = contour.nearest(point);
        prop_assert!((nearest.distance - oracle::distance(&contour, point)).abs() < ROUNDING);
        prop_assert!(((nearest.point - point).norm() - nearest.distance).abs() < ROUNDING);
        prop_assert!((contour.point_at(nearest.arc_length) - nearest.point).norm() < ROUNDING);
        prop_assert!((0.0..=contour.length()).contains(&nearest.arc_length));
        prop_assert!((contour.signed_distance(point).abs() - nearest.distance).abs() < ROUNDING);
    }

    #[test]
    fn around_every_corner_the_nearest_piece_is_found(
        contour in random::any_contour(),
        radius in 1e-4..0.2_f64,
        angle in -PI..PI,
    ) {
        for piece in contour.pieces() {
            let point = piece.start() + unit(angle) * radius;
            prop_assert!((contour.nearest(point).distance - oracle::distance(&contour, point)).abs() < ROUNDING);
        }
    }

    #[test]
    fn inside_is_negative_and_outside_positive(
        (contour, point) in random::with_point(random::closed()),
        direction in -PI..PI,
    ) {
        let distance = contour.signed_distance(point);
        let inside = oracle::inside(&contour, point, direction);
        prop_assert!(distance.abs() < 1e-12 || (distance < 0.0) == inside, "{distance}");
        prop_assert!(distance.abs() < 1e-12 || contour.contains(point) == inside);
    }

    #[test]
    fn beside_an_open_contour_left_is_negative_and_right_positive(
        contour in random::open(),
        share in 0.001..0.999_f64,
        aside in -0.1..0.1_f64,
    ) {
        let s = share * contour.length();
        let tangent = contour.tangent_at(s);
        let point = contour.point_at(s) + nalgebra::Vector2::new(tangent.y, -tangent.x) * aside;
        // The claim is about points whose nearest point is that one.
        prop_assume!(aside != 0.0 && (oracle::distance(&contour, point) - aside.abs()).abs() < ROUNDING);
        prop_assert!((contour.signed_distance(point) - aside).abs() < ROUNDING);
    }

    #[test]
    fn points_of_a_contour_are_at_no_distance(contour in random::any_contour(), share in 0.0..1.0_f64) {
        prop_assert!(contour.signed_distance(contour.point_at(share * contour.length())).abs() < ROUNDING);
    }

    #[test]
    fn the_distance_changes_no_faster_than_the_point_moves(
        (contour, point) in random::with_point(random::closed()),
        step in random::point(0.05),
    ) {
        let there = contour.signed_distance(point + step.coords);
        prop_assert!((there - contour.signed_distance(point)).abs() <= step.coords.norm() + ROUNDING);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_sample_is_nearer_than_the_nearest_point_and_one_is_nearly_as_near(
        (contour, point) in random::with_point(random::any_contour()),
    ) {
        let spacing = contour.length() / 2000.0;
        let nearest = contour.nearest(point).distance;
        let sampled = contour.sample(spacing).iter().map(|sample| (sample.point - point).norm()).fold(9.0, f64::min);
        prop_assert!(sampled >= nearest - ROUNDING && sampled <= nearest + 0.51 * spacing);
    }
}

#[test]
fn at_a_cusp_the_tip_of_a_spike_has_the_outside_around_it() {
    // Two quarter circles that part at the origin along +x; the interior is between them.
    let horn = Contour::closed(vec![
        Piece::arc(Point2::new(0.0, -1.0), 1.0, 0.5 * PI, -0.5 * PI),
        Piece::segment(Point2::new(1.0, -1.0), Point2::new(1.0, 1.0)),
        Piece::arc(Point2::new(0.0, 1.0), 1.0, 0.0, -0.5 * PI),
    ])
    .unwrap();
    for k in 0..9 {
        let angle = PI * (0.55 + 0.1 * f64::from(k));
        let beyond = Point2::new(angle.cos(), angle.sin()) * 1e-3;
        assert!((horn.signed_distance(beyond) - 1e-3).abs() < ROUNDING);
    }
    assert!(horn.contains(Point2::new(0.1, 0.0)));
}

#[test]
fn straight_across_a_cusp_is_the_other_side() {
    // Two of the half circles meet at (−0.1, 0), both as near, to rounding, to a point across their common tangent.
    let outer = Piece::arc(Point2::origin(), 0.1, 0.0, PI);
    let inner = Piece::arc(Point2::new(-0.06, 0.0), 0.04, PI, -PI);
    let last = Piece::arc(Point2::new(0.04, 0.0), 0.06, PI, -PI);
    let arbelos = Contour::closed(vec![outer, inner, last]).unwrap();
    for k in 1..2000 {
        let across = 1e-5 * f64::from(k);
        let pose = Pose { position: Point2::new(0.3, -0.8), heading: 0.01 * f64::from(k) };
        let point = pose.point_to_world(Point2::new(-0.1 + across, 1e-9));
        assert!((arbelos.transformed(&pose).signed_distance(point) - across).abs() < ROUNDING);
    }
}

#[test]
fn coordinates_that_are_no_numbers_have_no_distance() {
    let disk = circle(Point2::origin(), 0.1).unwrap();
    assert!(disk.signed_distance(Point2::new(f64::NAN, 0.0)).is_nan());
    assert!(!disk.contains(Point2::new(f64::NAN, 0.0)));
}
