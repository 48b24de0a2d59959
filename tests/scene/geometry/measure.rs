//! Lengths, areas, samples.

use std::f64::consts::TAU;

use proptest::prelude::*;

use crate::geometry::oracle::{self, ROUNDING};
use crate::geometry::random;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn along_a_contour_no_chord_is_longer_than_its_arc(
        contour in random::any_contour(),
        share in 0.0..1.0_f64,
        step in 0.0..0.1_f64,
    ) {
        let s = share * contour.length();
        let chord = (contour.point_at(s + step) - contour.point_at(s)).norm();
        prop_assert!(chord <= step + ROUNDING);
    }

    #[test]
    fn a_contour_is_as_long_as_its_pieces_and_goes_through_their_ends(contour in random::any_contour()) {
        let mut s = 0.0;
        for piece in contour.pieces() {
            prop_assert!((contour.point_at(s) - piece.start()).norm() < ROUNDING);
            s += piece.length();
            prop_assert!((contour.point_at(s) - piece.end()).norm() < 1e-9);
        }
        prop_assert!((s - contour.length()).abs() < ROUNDING);
    }

    #[test]
    fn the_tangent_is_the_speed_of_the_point(contour in random::any_contour(), share in 0.01..0.99_f64) {
        let (s, step) = (share * contour.length(), 1e-7);
        prop_assume!(contour.corners().iter().all(|corner| (corner.arc_length - s).abs() > 2.0 * step));
        let speed = (contour.point_at(s + step) - contour.point_at(s - step)) / (2.0 * step);
        prop_assert!((speed - contour.tangent_at(s)).norm() < 1e-4);
    }

    #[test]
    fn all_of_a_closed_contour_is_in_its_box_which_it_fills(contour in random::closed()) {
        let bounds = contour.bounding_box();
        let points = contour.sample(contour.length() / 500.0);
        for sample in &points {
            prop_assert!((sample.point - bounds.min).min() > -ROUNDING && (bounds.max - sample.point).min() > -ROUNDING);
        }
        let slack = contour.length() / 500.0;
        let gaps = |axis: usize| {
            let low = points.iter().map(|p| p.point[axis] - bounds.min[axis]).fold(9.0, f64::min);
            let high = points.iter().map(|p| bounds.max[axis] - p.point[axis]).fold(9.0, f64::min);
            low.max(high)
        };
        prop_assert!(gaps(0) < slack && gaps(1) < slack);
    }

    #[test]
    fn going_round_once_turns_once(contour in random::closed()) {
        let corners: f64 = contour.corners().iter().map(|corner| corner.turn).sum();
        let bends: f64 = contour.pieces().iter().map(|piece| piece.curvature() * piece.length()).sum();
        prop_assert!((corners + bends - TAU).abs() < 1e-4, "{}", corners + bends);
    }

    #[test]
    fn a_convex_contour_has_its_chords_inside(
        contour in random::closed(),
        from in 0.0..1.0_f64,
        to in 0.0..1.0_f64,
    ) {
        if contour.is_convex() {
            let [a, b] = [from, to].map(|share| contour.point_at(share * contour.length()));
            prop_assert!(contour.signed_distance(nalgebra::center(&a, &b)) < ROUNDING);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_area_is_the_limit_of_those_of_inscribed_polygons(contour in random::closed()) {
        let spacing = contour.length() / 4000.0;
        let points: Vec<_> = contour
            .pieces()
            .iter()
            .flat_map(|piece| {
                let parts = (piece.length() / spacing).ceil();
                (0..4001_u16).map(f64::from).take_while(move |&k| k < parts).map(move |k| {
                    piece.point_at(piece.length() * k / parts)
                })
            })
            .collect();
        let origin = points[0];
        let polygon: f64 = (0..points.len())
            .map(|k| 0.5 * (points[k] - origin).perp(&(points[(k + 1) % points.len()] - origin)))
            .sum();
        // Each chord cuts off κ s³ / 12.
        let cut: f64 = contour.pieces().iter().map(|piece| piece.curvature().abs() * piece.length()).sum();
        prop_assert!((contour.area() - polygon).abs() <= cut * spacing * spacing / 12.0 + ROUNDING);
        prop_assert!(contour.area() > 0.0);
    }

    #[test]
    fn samples_are_evenly_spaced_points_of_the_contour(contour in random::any_contour(), spacing in 0.001..0.1_f64) {
        let points = contour.sample(spacing);
        let step = if points.len() > 1 { points[1].arc_length } else { contour.length() };
        prop_assert!(step <= spacing * (1.0 + 1e-12));
        for (k, sample) in points.iter().enumerate() {
            prop_assert!((sample.arc_length - step * k as f64).abs() < 1e-12);
            prop_assert!((contour.point_at(sample.arc_length) - sample.point).norm() < 1e-12);
            prop_assert!(oracle::distance(&contour, sample.point) < ROUNDING);
        }
    }
}
