//! The deflection polynomial as a contact estimator.

use proptest::prelude::*;
use vibrissa::geometry::{Pose, Vector2, unit};
use vibrissa_runtime::calibration::{Calibration, ContactSet, DeflectionPolynomial};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::mechanics::Elastica;
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

/// What is told of a whisker of the rig at rest, bent by `base_angle` (rad).
fn told(rig: &Rig, whisker: usize, base_angle: f64) -> Perception {
    let mut perception = Perception::new(rig, &[Some(whisker)], &[ContactEstimatorKind::Polynomial]).unwrap();
    for tick in 0..12 {
        let samples: [Sample; 10] = std::array::from_fn(|index| {
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            whiskers[whisker].base_angle = base_angle;
            Sample {
                time: f64::from(tick * 10 + i32::try_from(index).unwrap()) / 300.0,
                body: Pose::default(),
                whiskers,
            }
        });
        perception.update(&samples);
    }
    perception
}

fn tip_base(perception: &Perception) -> Vector2 {
    perception.whisker_vector(0, WhiskerVector::TipBase)
}

/// The contact of a tip by the elastica (m, frame of the base), for a bend to the left.
fn exact(whisker: &Whisker, base_angle: f64, normal: f64) -> Vector2 {
    let elastica = Elastica::new(whisker);
    let mut shape = elastica.straight();
    for share in 1..=20 {
        shape = elastica.solve_tip(base_angle * f64::from(share) / 20.0, normal, &shape).unwrap();
    }
    shape.contact_base - whisker.shaft.radius_at(1.0) * unit(normal)
}

fn mirrored(position: Vector2, bend_sign: f64) -> Vector2 {
    Vector2::new(position.x, bend_sign * position.y)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_touch_of_a_surface_beside_the_platform_is_found_to_0_6_mm_and_within_its_spread(
        whisker in 0..2_usize, base_angle in 3e-5..4.99e-4_f64,
    ) {
        let rig = Rig::default();
        let bend_sign = rig.whiskers[whisker].side();
        let perception = told(&rig, whisker, bend_sign * base_angle);
        let expected = exact(&rig.whiskers[whisker], base_angle, rig.whiskers[whisker].usual_normal());
        let error = (tip_base(&perception) - mirrored(expected, bend_sign)).norm();
        prop_assert!(error < 6e-4, "{error} m at {base_angle} rad");
        let deviation = perception.contact(0).unwrap().deviation;
        prop_assert!(error < 2.0 * deviation && deviation < 4e-3, "{error} m, {deviation} m");
    }

    /// The report's range is -50 to 500 µrad.
    #[test]
    fn beyond_the_range_of_either_side_there_is_no_touch_and_the_tip_stays_at_the_end(
        whisker in 0..2_usize, (most, sign) in prop_oneof![Just((5e-4, 1.0)), Just((5e-5, -1.0))], beyond in 1.01..20.0_f64,
    ) {
        let rig = Rig::default();
        let end = sign * rig.whiskers[whisker].side() * most;
        let (inside, outside) = (told(&rig, whisker, 0.999_999 * end), told(&rig, whisker, beyond * end));
        prop_assert!(inside.contact(0).is_some());
        prop_assert_eq!(outside.contact(0), None);
        prop_assert!((tip_base(&inside) - tip_base(&outside)).norm() < 1e-6);
        prop_assert!(outside.whisker(0, WhiskerScalar::TipDeviation).is_infinite());
    }

    #[test]
    fn the_tip_does_not_jump_where_the_bend_changes_its_side(whisker in 0..2_usize, base_angle in 0.0..1e-6_f64) {
        let rig = Rig::default();
        let straight = Vector2::new(rig.whiskers[whisker].shaft.length, 0.0);
        for base_angle in [base_angle, -base_angle] {
            // A whisker moves by 190 m per radian here.
            prop_assert!((tip_base(&told(&rig, whisker, base_angle)) - straight).norm() <= 250.0 * base_angle.abs());
        }
    }

    /// A whisker that is not the one that the rig tells of, touched at base angles from 200 µrad on.
    #[test]
    fn touches_of_another_whisker_repair_the_whole_range(softness in 0.85..0.95_f64, base_angle in 3e-5..4.9e-4_f64) {
        let mut rig = Rig::default();
        let mut true_whisker = rig.whiskers[1].clone();
        true_whisker.shaft.young_modulus *= softness;
        let touches = (0..5).flat_map(|turn| (0..12).map(move |step| (turn, step))).map(|(turn, step)| {
            let normal = true_whisker.usual_normal() + (f64::from(turn) - 2.0) * 5_f64.to_radians();
            let base_angle = 2e-4 + 3e-5 * f64::from(step);
            let contact_base = exact(&true_whisker, base_angle, normal);
            (ContactSet { contact_base, base_angle, normal: Some(normal), on_shaft: false }, 1.0)
        });
        let polynomial = DeflectionPolynomial::fit(&touches.collect::<Vec<_>>(), true_whisker.shaft.length).unwrap();
        prop_assert!((polynomial.range - 5e-4).abs() < 1e-12);
        let mut calibration = Calibration::new("touched".to_owned());
        calibration.polynomial = Some(polynomial);
        let expected = exact(&true_whisker, base_angle, true_whisker.usual_normal());
        let error = |rig: &Rig| (tip_base(&told(rig, 1, base_angle)) - expected).norm();
        let uncalibrated = error(&rig);
        rig.whiskers[1].calibration = Some(calibration);
        prop_assert!(error(&rig) < 1e-3, "{} m at {base_angle} rad", error(&rig));
        prop_assert!(base_angle < 2e-4 || error(&rig) < 0.3 * uncalibrated, "{} m of {uncalibrated} m", error(&rig));
    }
}

#[test]
fn touches_that_do_not_determine_the_polynomial_give_none() {
    let set = |x: f64, y: f64, base_angle: f64| {
        (ContactSet { contact_base: Vector2::new(x, y), base_angle, normal: None, on_shaft: false }, 1.0)
    };
    assert_eq!(DeflectionPolynomial::fit(&[], 0.1), None);
    let at_one_angle: Vec<_> = (0..50).map(|index| set(0.08, 0.05 + 1e-4 * f64::from(index), 3e-4)).collect();
    assert_eq!(DeflectionPolynomial::fit(&at_one_angle, 0.1), None);
    let beyond: Vec<_> = (0..50).map(|index| set(0.05, 0.07, 6e-4 + 1e-6 * f64::from(index))).collect();
    assert_eq!(DeflectionPolynomial::fit(&beyond, 0.1), None);
}
