//! Keypoints of contours, and contours of positions.

use proptest::prelude::*;
use vibrissa::geometry::{Point2, Pose, Vector2, unit};
use vibrissa_runtime::machine::{
    ContactEstimatorKind, ContourVector, Keypoints, PositionContour, Senses, WhiskerScalar, WhiskerVector,
};
use vibrissa_runtime::percept::{LocalContour, Perception};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

/// The contour after those of the two whiskers.
const MIDDLE: usize = 2;

fn keypoints() -> impl Strategy<Value = Keypoints> {
    (Keypoints::COUNT, 1e-4..=0.02).prop_map(|(count, spacing)| Keypoints { count, spacing })
}

fn perception(keypoints: Keypoints) -> Perception {
    let kinds = [ContactEstimatorKind::OneChannel; 2];
    let perception = Perception::new(&Rig::default(), &[Some(0), Some(1)], &kinds).unwrap();
    perception.with_contours(keypoints, &[PositionContour { name: "middle".to_owned(), keypoints }])
}

/// Begins a tick in which both whiskers touch.
fn tick(perception: &mut Perception, number: usize) {
    let mut whiskers = [Reading::default(); MAX_WHISKERS];
    whiskers[0].base_angle = -3e-4;
    whiskers[1].base_angle = 3e-4;
    let body = Pose { position: Point2::new(0.0, 0.025 * number as f64), heading: 1.5 };
    perception.update(&[Sample { time: number as f64 / 30.0, body, whiskers }; 10]);
}

fn is_ready(perception: &Perception, contour: usize) -> bool {
    perception.whisker(contour, WhiskerScalar::ContourReady) > 0.5
}

proptest! {
    #[test]
    fn a_contour_is_ready_as_soon_as_it_has_its_number_of_points(keypoints in keypoints()) {
        let mut perception = perception(keypoints);
        // Each tick moves the body, and the positions, by more than the largest spacing.
        for number in 0..20 {
            tick(&mut perception, number);
            for whisker in 0..2 {
                perception.record(whisker);
            }
            perception.record_position(0, Vector2::new(0.025 * number as f64, 1.0));
            for contour in 0..=MIDDLE {
                prop_assert_eq!(is_ready(&perception, contour), number + 1 >= keypoints.count, "{} {}", contour, number);
            }
        }
    }

    #[test]
    fn points_that_are_too_close_do_not_count(keypoints in keypoints(), share in 0.01..0.99) {
        let mut contour = LocalContour::new(keypoints);
        for number in 0..40 {
            contour.add(Point2::new(0.0, keypoints.spacing * share * f64::from(number % 2)));
        }
        prop_assert!(!contour.is_ready());
    }

    #[test]
    fn the_curve_of_a_parabola_is_the_parabola(
        keypoints in keypoints(), heading in -3.0..3.0_f64, bend in -0.1..0.1_f64, turned in -3.0..3.0_f64,
    ) {
        // The parameter of the fit is the length of the chords, so that a slight parabola is nearly exact.
        let mut contour = LocalContour::new(keypoints);
        let step = 1.01 * keypoints.spacing;
        let length = step * (keypoints.count - 1) as f64;
        let along: Vector2 = unit(heading);
        let across = Vector2::new(-along.y, along.x);
        let place = |at: f64| Point2::from(unit(turned) + along * at + across * (bend * at * at / length));
        for number in 0..keypoints.count {
            contour.add(place(step * number as f64));
        }
        let slope: Vector2 = (along + across * (2.0 * bend)).normalize();
        prop_assert!((contour.tangent().unwrap() - slope).norm() < 0.05 * bend.abs() + 1e-6, "{:?}", contour.tangent());
        prop_assert!((contour.point_at(0.0).unwrap() - place(length)).norm() < 0.02 * length * bend.abs() + 1e-9);
    }
}

#[test]
fn without_a_declaration_the_points_are_those_that_a_contour_always_had() {
    let mut plain = LocalContour::default();
    let mut given = LocalContour::new(Keypoints { count: 7, spacing: 1e-3 });
    for number in 0..30 {
        let point = Point2::from(0.3 * unit(0.002 * f64::from(number)));
        plain.add(point);
        given.add(point);
        let bits = |contour: &LocalContour| contour.tangent().map(|tangent| [tangent.x.to_bits(), tangent.y.to_bits()]);
        assert_eq!(bits(&plain), bits(&given));
        assert_eq!(plain.is_ready(), number >= 12, "every second point counts: {number}");
    }
}

#[test]
fn a_contour_of_positions_has_a_normal_to_its_left_and_restarts_after_a_gap() {
    let keypoints = Keypoints { count: 4, spacing: 5e-3 };
    let mut perception = perception(keypoints);
    let undefined = |vector: Vector2| vector.iter().all(|part| part.is_nan());
    for number in 0..6 {
        tick(&mut perception, number);
        assert!(number > 3 || undefined(perception.whisker_vector(MIDDLE, WhiskerVector::ContourTangent)));
        perception.record_position(0, Vector2::new(1.0, 0.01 * number as f64));
        // Only the first position of a tick counts, and only a number.
        perception.record_position(0, Vector2::new(9.0, 9.0));
    }
    let near = |vector: Vector2, x: f64, y: f64| assert!((vector - Vector2::new(x, y)).norm() < 1e-9, "{vector}");
    near(perception.whisker_vector(MIDDLE, WhiskerVector::ContourTangent), 0.0, 1.0);
    near(perception.whisker_vector(MIDDLE, WhiskerVector::ContourNormal), -1.0, 0.0);
    near(perception.whisker_vector(MIDDLE, WhiskerVector::ContourEnd), 1.0, 0.05);
    near(perception.contour_at(MIDDLE, 0.01, ContourVector::Point), 1.0, 0.04);
    assert!(perception.whisker(MIDDLE, WhiskerScalar::ContourCurvature).abs() < 1e-6);
    assert!(!is_ready(&perception, 0) && is_ready(&perception, MIDDLE), "contours are separate");

    tick(&mut perception, 6);
    perception.record_position(0, Vector2::new(f64::NAN, 0.0));
    near(perception.whisker_vector(MIDDLE, WhiskerVector::ContourEnd), 1.0, 0.05);
    assert!(is_ready(&perception, MIDDLE), "a position that is no number adds nothing");
    for number in 7..10 {
        assert_eq!(is_ready(&perception, MIDDLE), number < 9, "the tick before counts: {number}");
        tick(&mut perception, number);
    }
    near(perception.whisker_vector(MIDDLE, WhiskerVector::ContourEnd), 1.0, 0.05);
    perception.record_position(0, Vector2::new(2.0, 2.0));
    near(perception.whisker_vector(MIDDLE, WhiskerVector::ContourEnd), 2.0, 2.0);
    assert!(undefined(perception.whisker_vector(MIDDLE, WhiskerVector::ContourTangent)));
}
