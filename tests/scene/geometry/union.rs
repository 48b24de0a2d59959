//! Unions, by what points are in them.

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Point2, TOUCHING, UnionError, circle, polygon, rounded_rectangle, unite};

use super::random::{pose, star};

/// Rectangles, disks and star-shaped polygons that overlap more often than not.
fn outline() -> impl Strategy<Value = Contour> {
    let rectangle = (0.02..0.6_f64, 0.02..0.6_f64, 0.0..0.5_f64).prop_map(|(width, height, share)| {
        rounded_rectangle(Point2::origin(), width, height, share * width.min(height), 0.0)
    });
    let rectangle = rectangle.prop_map(Result::unwrap);
    let disk = (0.02..0.4_f64).prop_map(|radius| circle(Point2::origin(), radius).unwrap());
    let polygon = star().prop_filter_map("it meets itself", |corners| polygon(&corners).ok());
    (prop_oneof![rectangle, disk, polygon], pose()).prop_map(|(outline, pose)| outline.transformed(&pose))
}

/// Rectangles on a grid: they share corners and sides, or parts of these.
fn block() -> impl Strategy<Value = Contour> {
    (0_u8..6, 0_u8..6, 1_u8..4, 1_u8..4).prop_map(|(x, y, width, height)| {
        let [x, y, width, height] = [x, y, width, height].map(|cells| 0.1 * f64::from(cells));
        rounded_rectangle(Point2::new(x + 0.5 * width, y + 0.5 * height), width, height, 0.0, 0.0).unwrap()
    })
}

/// Checks the union of outlines, by points on a grid and on all outlines.
fn is_union(outlines: &[Contour]) -> Result<(), TestCaseError> {
    let united = match unite(outlines) {
        Ok(united) => united,
        // A hole is enclosed by what is no part of it.
        Err(UnionError::Hole { at, .. }) => {
            let least = outlines.iter().map(|outline| outline.signed_distance(at)).fold(f64::INFINITY, f64::min);
            prop_assert!(least.abs() < 4.0 * TOUCHING);
            return Ok(());
        }
        Err(error) => return Err(TestCaseError::fail(error.to_string())),
    };
    prop_assert!(united.windows(2).all(|pair| pair[0].first <= pair[1].first));
    let depth =
        |point: Point2| outlines.iter().map(|outline| outline.signed_distance(point)).fold(f64::INFINITY, f64::min);
    for united in united.iter().map(|united| &united.outline) {
        for step in 0..200 {
            let place = united.point_at(united.length() * f64::from(step) / 200.0);
            prop_assert!(depth(place).abs() < 4.0 * TOUCHING, "{place} is not on the outline of all");
        }
    }
    let contains = |point: Point2| united.iter().any(|united| united.outline.contains(point));
    for row in 0..60 {
        for column in 0..60 {
            let point = Point2::new(-1.511 + f64::from(column) * 0.0503, -1.507 + f64::from(row) * 0.0501);
            let depth = depth(point);
            prop_assert!(depth.abs() < 4.0 * TOUCHING || contains(point) == (depth < 0.0), "at {point}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_point_is_in_a_union_if_it_is_in_one_of_its_outlines(outlines in prop::collection::vec(outline(), 2..6)) {
        is_union(&outlines)?;
    }

    #[test]
    fn sides_and_corners_may_be_shared(outlines in prop::collection::vec(block(), 2..8)) {
        is_union(&outlines)?;
    }

    /// Two rectangles of one direction overlap in a rectangle.
    #[test]
    fn areas_add_up_but_for_what_is_shared(
        x in -0.3..0.3_f64, y in -0.3..0.3_f64, a in 0.05..0.3_f64, b in 0.05..0.3_f64, c in 0.05..0.3_f64, d in 0.05..0.3_f64, pose in pose(),
    ) {
        let rectangle = |x, y, width, height| {
            rounded_rectangle(Point2::new(x, y), width, height, 0.0, 0.0).unwrap().transformed(&pose)
        };
        let shared = |apart: f64, one: f64, other: f64| (0.5 * (one + other) - apart.abs()).min(one).min(other).max(0.0);
        let expected = a * b + c * d - shared(x, a, c) * shared(y, b, d);
        let united = unite(&[rectangle(0.0, 0.0, a, b), rectangle(x, y, c, d)]).unwrap();
        let area: f64 = united.iter().map(|united| united.outline.area()).sum();
        prop_assert!((area - expected).abs() < 1e-5, "{area} m² for {expected} m²");
    }

    #[test]
    fn what_keeps_apart_stays_as_it_is_to_the_last_bit(outlines in prop::collection::vec(outline(), 1..6)) {
        let moved = outlines.iter().zip(0_u8..).map(|(outline, index)| {
            let position = Point2::new(5.0 * f64::from(index), 0.0);
            outline.transformed(&vibrissa::geometry::Pose { position, heading: 0.0 })
        });
        let moved: Vec<Contour> = moved.collect();
        let united = unite(&moved).unwrap();
        prop_assert_eq!(united.len(), moved.len());
        for (united, outline) in united.iter().zip(&moved) {
            prop_assert_eq!(united.outline.pieces(), outline.pieces());
        }
    }
}

fn square(x: f64, y: f64) -> Contour {
    rounded_rectangle(Point2::new(x, y), 0.1, 0.1, 0.0, 0.0).unwrap()
}

#[test]
fn boxes_side_by_side_become_one_box_also_across_a_gap_of_nanometres() {
    for gap in [-1e-4, -1e-7, -1e-9, 0.0, 1e-12, 1e-9, 1e-8, 5e-7] {
        let united = unite(&[square(0.0, 0.0), square(0.1 + gap, 0.0)]).unwrap();
        let [whole] = united.as_slice() else { panic!("{gap}: {} outlines", united.len()) };
        assert!((whole.outline.area() - 0.1 * (0.2 + gap)).abs() < 2e-7, "{gap}");
        assert_eq!(whole.outline.corners().len(), 4, "{gap}");
    }
    assert_eq!(unite(&[square(0.0, 0.0), square(0.1 + 3e-6, 0.0)]).unwrap().len(), 2);
}

#[test]
fn what_touches_in_a_point_alone_stays_apart() {
    assert_eq!(unite(&[square(0.0, 0.0), square(0.1, 0.1)]).unwrap().len(), 2);
    let disk = |x| circle(Point2::new(x, 0.0), 0.1).unwrap();
    assert_eq!(unite(&[disk(0.0), disk(0.2)]).unwrap().len(), 2);
    assert_eq!(unite(&[disk(0.0), square(0.15, 0.0)]).unwrap().len(), 2);
}

#[test]
fn what_lies_in_another_and_what_is_drawn_twice_counts_once() {
    let (large, small) = (circle(Point2::origin(), 0.3).unwrap(), circle(Point2::new(0.1, 0.0), 0.1).unwrap());
    for outlines in [[small.clone(), large.clone()], [large.clone(), large.clone()]] {
        let united = unite(&outlines).unwrap();
        assert_eq!(united.len(), 1);
        assert_eq!(united[0].outline.pieces(), large.pieces());
    }
}

#[test]
fn a_ring_encloses_a_hole() {
    let bar = |x, y, width, height| rounded_rectangle(Point2::new(x, y), width, height, 0.0, 0.0).unwrap();
    let ring = [bar(0.0, 0.4, 1.0, 0.2), bar(0.0, -0.4, 1.0, 0.2), bar(0.4, 0.0, 0.2, 0.6), bar(-0.4, 0.0, 0.2, 0.6)];
    assert!(matches!(unite(&ring), Err(UnionError::Hole { .. })));
    assert_eq!(unite(&ring[..3]).unwrap().len(), 1);
}
