//! Parallel contours.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use vibrissa::geometry::{Contour, OffsetError, Point2, circle, polygon, regular_polygon, rounded_rectangle};

use crate::{oracle, random};

const EXACT: f64 = 1e-7;
/// The most offsets that may be refused in 2000 cases, those of kept counterexamples among them.
const REFUSALS: u32 = 4;

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

fn check(contour: &Contour, distance: f64, points: &[Point2]) -> Result<(), TestCaseError> {
    let found = match contour.offset(distance) {
        Ok(found) => found,
        // A known defect: some contours are refused over a range of distances, not only where a parallel touches itself.
        // A refusal is never a wrong contour; `REFUSALS` bounds how many there may be.
        Err(error @ OffsetError::Unsound { .. }) => return Err(TestCaseError::reject(error.to_string())),
        Err(error) => return Err(TestCaseError::fail(format!("{error}"))),
    };
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
    #![proptest_config(ProptestConfig { max_global_rejects: REFUSALS, ..ProptestConfig::with_cases(2000) })]

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

#[test]
fn a_distance_that_is_no_number_is_refused() {
    let disk = circle(Point2::origin(), 0.3).unwrap();
    assert!(matches!(disk.offset(f64::NAN), Err(OffsetError::NotFinite { .. })));
}
