//! Parallel contours.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use vibrissa::geometry::{Contour, OffsetError, Piece, Point2, circle, polygon, regular_polygon, rounded_rectangle};

use crate::geometry::{oracle, random};

const EXACT: f64 = 1e-7;
/// A distance (m) from one at which a parallel touches itself, splits or vanishes, at which it no longer does.
const ASIDE: f64 = 1e-6;

/// The point at the distance from the contour on the way from a point's nearest point to that point.
fn at_distance(contour: &Contour, point: Point2, distance: f64) -> Option<Point2> {
    let nearest = contour.nearest(point);
    let away = (point - nearest.point).try_normalize(1e-9)?;
    Some(nearest.point + away * distance.abs())
}

/// Distances on either side.
fn distance(largest: f64) -> impl Strategy<Value = f64> {
    prop_oneof![1e-6..largest, -largest..-1e-6]
}

/// Whether a point is nearest to an end of an open contour, where the two sides meet.
fn at_free_end(contour: &Contour, point: Point2) -> bool {
    let s = contour.nearest(point).arc_length;
    !contour.is_closed() && (s <= 0.0 || s >= contour.length())
}

/// The parallels at a distance. Where rounding decides their form there need be none, so then those just aside from it, and
/// their distance.
fn parallels(contour: &Contour, distance: f64) -> Result<(Vec<Contour>, f64), TestCaseError> {
    for distance in [distance, distance + ASIDE, distance - ASIDE] {
        match contour.offset(distance) {
            Ok(found) => return Ok((found, distance)),
            Err(OffsetError::Unsound { .. }) => {}
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        }
    }
    Err(TestCaseError::fail(format!("refused at {distance} and on both sides of it")))
}

fn check(contour: &Contour, distance: f64, points: &[Point2]) -> Result<(), TestCaseError> {
    let (found, distance) = parallels(contour, distance)?;
    let ends = |parallel: &Contour| (parallel.point_at(0.0), parallel.point_at(parallel.length()));
    for (start, _) in found.iter().filter(|parallel| !parallel.is_closed()).map(ends) {
        for (_, end) in found.iter().filter(|parallel| !parallel.is_closed()).map(ends) {
            prop_assert!((end - start).norm() > EXACT, "parallels meet at {start} and are not joined");
        }
    }
    for parallel in &found {
        prop_assert!(parallel.is_closed() || !contour.is_closed());
        for sample in parallel.sample(parallel.length() / 200.0) {
            prop_assert!((oracle::distance(contour, sample.point) - distance.abs()).abs() < EXACT);
            // Where an open parallel ends it may be as near to the other side of another part.
            let end = sample.arc_length <= 0.0 || sample.arc_length >= parallel.length();
            if parallel.is_closed() || !end {
                prop_assert!(contour.signed_distance(sample.point) * distance > 0.0);
            }
        }
    }
    for &point in points {
        let Some(point) = at_distance(contour, point, distance) else { continue };
        // Points around the free ends are not part of a parallel contour.
        if (contour.signed_distance(point) - distance).abs() < 1e-13 && !at_free_end(contour, point) {
            let miss = found.iter().map(|parallel| oracle::distance(parallel, point)).fold(9.0, f64::min);
            prop_assert!(miss < EXACT, "{miss} at {point}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_parallels_of_a_closed_contour_are_all_the_points_at_that_distance(
        contour in random::closed(),
        distance in distance(0.2),
        points in prop::collection::vec(random::point(0.7), 100),
    ) {
        let centre = nalgebra::center(&contour.bounding_box().min, &contour.bounding_box().max);
        let points: Vec<_> = points.iter().map(|point| centre + point.coords).collect();
        check(&contour, distance, &points)?;
    }

    #[test]
    fn near_parallels_are_as_exact_as_far_ones(
        contour in random::closed(),
        exponent in -7.5..-2.0_f64,
        outside in any::<bool>(),
        points in prop::collection::vec(random::point(0.7), 100),
    ) {
        let distance = 10.0_f64.powf(exponent) * if outside { 1.0 } else { -1.0 };
        let centre = nalgebra::center(&contour.bounding_box().min, &contour.bounding_box().max);
        let points: Vec<_> = points.iter().map(|point| centre + point.coords).collect();
        check(&contour, distance, &points)?;
    }

    #[test]
    fn the_parallels_of_an_open_contour_are_the_points_at_that_distance_beside_it(
        contour in random::open(),
        distance in distance(0.1),
        points in prop::collection::vec(random::point(0.7), 100),
    ) {
        let centre = nalgebra::center(&contour.bounding_box().min, &contour.bounding_box().max);
        let points: Vec<_> = points.iter().map(|point| centre + point.coords).collect();
        check(&contour, distance, &points)?;
    }

    #[test]
    fn a_convex_contour_grows_by_the_formula_of_steiner(contour in random::convex(), distance in 1e-6..0.2_f64) {
        prop_assert!(contour.is_convex());
        let grown = contour.offset(distance).unwrap();
        prop_assert_eq!(grown.len(), 1);
        let area = contour.area() + contour.length() * distance + PI * distance * distance;
        prop_assert!((grown[0].area() - area).abs() < 1e-9);
        prop_assert!((grown[0].length() - (contour.length() + TAU * distance)).abs() < 1e-9);
        prop_assert!(grown[0].is_convex());
    }
}

#[test]
fn a_circle_stays_one_piece_and_vanishes_beyond_its_centre() {
    let disk = circle(Point2::new(0.4, 0.4), 0.3).unwrap();
    assert_eq!(disk.offset(0.01).unwrap()[0].pieces().len(), 1);
    assert!(disk.offset(-0.31).unwrap().is_empty());
}

#[test]
fn where_there_is_just_no_room_left_nothing_is() {
    let centre = Point2::new(0.3, 0.2);
    let bar = rounded_rectangle(centre, 0.3, 0.01, 0.0, 0.3).unwrap();
    let stadium = rounded_rectangle(centre, 0.3, 0.1, 0.05, 0.3).unwrap();
    let octagon = regular_polygon(centre, 0.3, 8, 0.3).unwrap();
    assert!(bar.offset(-0.005).unwrap().is_empty());
    assert!(stadium.offset(-0.05).unwrap().is_empty());
    assert!(octagon.offset(-0.3 * (PI / 8.0).cos()).unwrap().is_empty());
    assert!(circle(centre, 0.3).unwrap().offset(-0.3).unwrap().is_empty());
}

#[test]
fn a_mouth_that_closes_leaves_the_cavity_behind_it() {
    // A square box with walls of 20 mm and a mouth of 20 mm in its lid.
    let corners = [(0.04, 0.1), (0.0, 0.1), (0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.06, 0.1)];
    let inside = [(0.06, 0.08), (0.08, 0.08), (0.08, 0.02), (0.02, 0.02), (0.02, 0.08), (0.04, 0.08)];
    let points: Vec<_> = corners.iter().chain(&inside).map(|&(x, y)| Point2::new(x, y)).collect();
    let walls = polygon(&points).unwrap();
    assert_eq!(walls.offset(0.009).unwrap().len(), 1);
    for distance in [0.01, 0.011] {
        let mut found = walls.offset(distance).unwrap();
        found.sort_by(|a, b| a.area().total_cmp(&b.area()));
        assert_eq!(found.len(), 2);
        assert!(found[0].contains(Point2::new(0.05, 0.05)) && found[1].contains(Point2::new(0.01, 0.01)));
        assert!(!found[0].contains(Point2::new(0.01, 0.01)));
    }
}

/// An open contour along some corners and on to a small arc at the origin, which turns away from the parallels on the left.
/// The circle around the arc's end touches the arc's parallel from within, so that the two can hardly be told apart.
fn ending_in_an_arc(corners: &[(f64, f64)], radius: f64, sweep: f64) -> Contour {
    let corners: Vec<_> = corners.iter().chain(&[(0.0, -radius)]).map(|&(x, y)| Point2::new(x, y)).collect();
    let mut pieces: Vec<_> = corners.windows(2).map(|side| Piece::segment(side[0], side[1])).collect();
    pieces.push(Piece::arc(Point2::origin(), radius, -0.5 * PI, -sweep));
    Contour::open(pieces).unwrap()
}

#[test]
fn a_parallel_that_runs_into_its_own_start_just_before_its_end_is_closed_there() {
    let (d, r, sweep, before_end) = (0.05, 0.002, 0.5_f64, 0.001);
    let x = -d - (r + d) * (sweep - before_end).sin();
    let ring = ending_in_an_arc(&[(x, -0.03), (x, -0.4), (0.4, -0.4), (0.4, -r)], r, sweep);
    for step in -1000..=1000 {
        let distance = -d + 1e-6 * f64::from(step);
        let found = ring.offset(distance).unwrap();
        assert_eq!(found.len(), 1);
        // With less of a distance the crossing lies behind the end.
        assert_eq!(found[0].is_closed(), step <= 30, "{distance}");
        check(&ring, distance, &[]).unwrap();
    }
}

#[test]
fn a_parallel_that_ends_just_behind_its_last_corner_is_in_one_piece() {
    let (d, r, sweep, before_end) = (0.05, 0.002, 0.5_f64, 0.001);
    let x = d - (r + d) * (sweep - before_end).sin();
    let hook = ending_in_an_arc(&[(x, -0.4), (x, -r)], r, sweep);
    for step in -1000..=1000 {
        let distance = -d + 1e-6 * f64::from(step);
        assert_eq!(hook.offset(distance).unwrap().len(), 1, "{distance}");
        check(&hook, distance, &[]).unwrap();
    }
}

#[test]
fn a_distance_that_is_no_number_is_refused() {
    let disk = circle(Point2::origin(), 0.3).unwrap();
    assert!(matches!(disk.offset(f64::NAN), Err(OffsetError::NotFinite { .. })));
}
