//! Contours may not meet themselves.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;
use vibrissa::geometry::{Contour, ContourError, Piece, Point2, ShapeError, circle, polygon};

use crate::geometry::random;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn an_open_polyline_is_refused_exactly_where_two_of_its_sides_cross(
        points in prop::collection::vec(random::point(0.5), 3..7),
    ) {
        let pieces: Vec<_> = points.windows(2).map(|w| Piece::segment(w[0], w[1])).collect();
        let side = |a: Point2, b: Point2, p: Point2| (b - a).perp(&(p - a)) > 0.0;
        let cross = |i: usize, j: usize| {
            let (a, b, c, d) = (points[i], points[i + 1], points[j], points[j + 1]);
            side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
        };
        let crossing = (0..pieces.len()).any(|i| (i + 2..pieces.len()).any(|j| cross(i, j)));
        match Contour::open(pieces) {
            Ok(_) => prop_assert!(!crossing),
            Err(ContourError::SelfIntersection { first, second, .. }) => prop_assert!(cross(first, second)),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn a_closed_contour_with_two_corners_swapped_is_simple_or_names_where_it_meets_itself(
        mut corners in random::star(),
        index in any::<prop::sample::Index>(),
    ) {
        let k = index.index(corners.len() - 1);
        corners.swap(k, k + 1);
        match polygon(&corners) {
            Ok(contour) => prop_assert!(contour.area() > 0.0),
            Err(ShapeError::Contour(ContourError::SelfIntersection { first, second, at })) => {
                let n = corners.len();
                for side in [first, second] {
                    let piece = Piece::segment(corners[side], corners[(side + 1) % n]);
                    prop_assert!(piece.distance(at) < 1e-9);
                }
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn an_arc_over_a_line_is_refused_exactly_where_it_reaches_it(
        radius in 0.1..1.0_f64,
        height in 0.0..2.0_f64,
        // Short of coming back to where it started.
        sweep in 0.1..TAU - 1e-3,
    ) {
        // A line along the x axis, a way up, and an arc that starts at its top going left and down.
        prop_assume!((height - 2.0 * radius).abs() > 1e-6 && height > 1e-3);
        let top = Point2::new(0.0, height);
        let reached = height - radius * (1.0 - sweep.cos());
        prop_assume!(reached.abs() > 1e-6);
        let pieces = vec![
            Piece::segment(Point2::new(-3.0, 0.0), Point2::new(3.0, 0.0)),
            Piece::segment(Point2::new(3.0, 0.0), Point2::new(3.0, height)),
            Piece::segment(Point2::new(3.0, height), top),
            Piece::arc(top - Point2::new(0.0, radius).coords, radius, FRAC_PI_2, sweep),
        ];
        let lowest = if sweep >= PI { height - 2.0 * radius } else { reached };
        prop_assert_eq!(Contour::open(pieces).is_err(), lowest < 0.0);
    }
}

#[test]
fn a_contour_of_many_pieces_is_as_exact_as_one_of_few() {
    let teeth: u32 = 20_000;
    let gear: Vec<_> = (0..teeth)
        .map(|k| {
            let radius = if k % 2 == 0 { 0.3 } else { 0.29 };
            let angle = TAU * f64::from(k) / f64::from(teeth);
            Point2::new(radius * angle.cos(), radius * angle.sin())
        })
        .collect();
    let gear = polygon(&gear).unwrap();
    for sample in circle(Point2::origin(), 0.35).unwrap().sample(1e-4) {
        assert!((gear.signed_distance(sample.point) - 0.05).abs() < 1e-6);
    }
}
