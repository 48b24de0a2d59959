//! Shapes with a corner that is given by its angle.

use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Contour, Point2, Vector2, unit};
use vibrissa::scenario;

fn outline(object: &str) -> Contour {
    let text = format!(
        "name: corner\nobjects: [{object}]\nstart: {{position: [50 m, 50 m], heading: 0 deg}}\nstop: {{time: 1 s}}\n"
    );
    let scene =
        scenario::read(&Source::new("corner.yaml", text)).unwrap_or_else(|faults| panic!("{object}: {faults:?}"));
    assert_eq!(scene.solids.len(), 1);
    scene.solids[0].outline().clone()
}

/// The turn (rad) of an outline at a position, and the lengths of its sides there (m), sorted.
fn at(outline: &Contour, place: Point2) -> (f64, [f64; 2]) {
    let corners = outline.corners();
    let index = corners.iter().position(|corner| (corner.point - place).norm() < 1e-9).unwrap();
    let side = |other: usize| (corners[other % corners.len()].point - place).norm();
    let mut sides = [side(index + 1), side(index + corners.len() - 1)];
    sides.sort_by(f64::total_cmp);
    (corners[index].turn, sides)
}

proptest! {
    #[test]
    fn a_convex_corner_has_its_angle_its_place_and_its_direction(
        angle in 1.5_f64..174.5, heading in -180.0_f64..180.0, side in 0.05_f64..1.0, back in 0.05..1.0, x in -1.0..1.0,
    ) {
        let object = format!(
            "convex_corner: {{corner: [{x} m, 0.1 m], heading: {heading} deg, angle: {angle} deg, side: {side} m, back: {back} m}}"
        );
        let outline = outline(&object);
        let corner = Point2::new(x, 0.1);
        let (turn, sides) = at(&outline, corner);
        prop_assert!((turn.to_degrees() - angle).abs() < 1e-6);
        prop_assert!(sides.iter().all(|found| (found - side).abs() < 1e-9));
        prop_assert!(outline.is_convex());
        // Nothing of the object is ahead of the corner.
        let ahead = unit(heading.to_radians());
        let reach = outline.corners().iter().map(|other| (other.point - corner).dot(&ahead)).fold(f64::MIN, f64::max);
        prop_assert!(reach < 1e-9);
    }

    #[test]
    fn a_concave_corner_has_its_angle_and_the_free_space_on_its_side(
        angle in 5.0_f64..120.0, left: bool, heading in -180.0_f64..180.0, first in 0.2_f64..1.0, second in 0.2_f64..1.0,
    ) {
        let angle = if left { angle } else { -angle };
        let object = format!(
            "concave_corner: {{corner: [0 m, 0 m], heading: {heading} deg, angle: {angle} deg, first: {first} m, second: {second} m, thickness: 2 cm}}"
        );
        let outline = outline(&object);
        let (turn, sides) = at(&outline, Point2::origin());
        // An outline runs counter-clockwise, so it turns to the right at a concave corner.
        prop_assert!((turn.to_degrees() + angle.abs()).abs() < 1e-6, "{turn}");
        let mut lengths = [first, second];
        lengths.sort_by(f64::total_cmp);
        prop_assert!(sides.iter().zip(lengths).all(|(found, length)| (found - length).abs() < 1e-9));
        let along = unit(heading.to_radians());
        let free = if left { 1.0 } else { -1.0 } * Vector2::new(-along.y, along.x);
        let beside = Point2::origin() - 0.1 * along;
        prop_assert!(outline.signed_distance(beside + 0.01 * free) > 0.0);
        prop_assert!(outline.signed_distance(beside - 0.01 * free) < 0.0);
    }
}
