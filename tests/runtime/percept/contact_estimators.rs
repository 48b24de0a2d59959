//! What every tip model tells of a touch.

use proptest::prelude::*;
use vibrissa::geometry::{Point2, Pose};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::percept::{Contact, Perception};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

/// What the right whisker tells after one and a half seconds on a straight surface, bent by `base_angle` (rad).
fn touch(kind: ContactEstimatorKind, base_angle: f64, heading: f64) -> (Perception, Option<Contact>) {
    let mut rig = Rig::default();
    rig.sensing.forces = true;
    let mut perception = Perception::new(&rig, &[Some(0)], &[kind]).unwrap();
    for tick in 0..45 {
        let samples: [Sample; 10] = std::array::from_fn(|index| {
            let time = f64::from(tick * 10 + i32::try_from(index).unwrap()) / 300.0;
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            whiskers[0].base_angle = base_angle * (4.0 * time).min(1.0);
            // A lever of 90 mm on a hinge of 1 N m/rad.
            whiskers[0].shear = Some(whiskers[0].base_angle / 0.09);
            let along = 0.05 * time;
            let body = Pose { position: Point2::new(along * heading.cos(), along * heading.sin()), heading };
            Sample { time, body, whiskers }
        });
        perception.update(&samples);
        perception.record(0);
    }
    let touch = perception.contact(0).copied();
    (perception, touch)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn a_touch_has_a_covariance_that_is_one_and_holds_its_spread(
        kind in prop::sample::select(ContactEstimatorKind::ALL.to_vec()), base_angle in 1e-4..4e-4_f64, heading in -3.0..3.0_f64,
    ) {
        if let (perception, Some(touch)) = touch(kind, -base_angle, heading) {
            let covariance = touch.covariance_world;
            prop_assert!((covariance.m12 - covariance.m21).abs() <= 1e-12 * covariance.trace());
            let values = covariance.symmetric_eigenvalues();
            prop_assert!(values.min() >= -1e-9 * values.max() && values.max() > 0.0, "{values}");
            prop_assert!(touch.deviation.powi(2) <= 1.000_001 * covariance.trace());
            prop_assert!(touch.deviation.powi(2) >= 0.999_999 * values.min());
            prop_assert!(touch.contact_length > 0.0 && touch.contact_length <= 0.1);
            prop_assert_eq!(perception.recorded_tip(0), Some(touch.point_world));
        }
    }

    #[test]
    fn a_touch_goes_with_the_platform(
        kind in prop::sample::select(ContactEstimatorKind::ALL.to_vec()), base_angle in 1e-4..4e-4_f64, turn in -3.0..3.0_f64,
    ) {
        let (_, here) = touch(kind, -base_angle, 0.0);
        let (_, there) = touch(kind, -base_angle, turn);
        prop_assert_eq!(here.is_some(), there.is_some());
        if let (Some(here), Some(there)) = (here, there) {
            let turned = Pose { position: Point2::origin(), heading: turn };
            prop_assert!((turned.point_to_world(here.point_world) - there.point_world).norm() < 1e-9);
            let by = nalgebra::Rotation2::new(turn);
            let off = by * here.covariance_world * by.inverse() - there.covariance_world;
            prop_assert!(off.norm() < 1e-6 * here.covariance_world.norm(), "{off}");
        }
    }
}

#[test]
fn beyond_its_range_a_model_tells_no_touch_and_nothing_is_recorded() {
    // By two readings the range is where the mechanics have a touch with both.
    for kind in [
        ContactEstimatorKind::OneChannel,
        ContactEstimatorKind::Sliding,
        ContactEstimatorKind::Recursive,
        ContactEstimatorKind::Polynomial,
    ] {
        let (perception, found) = touch(kind, -2e-3, 1.0);
        assert_eq!(found, None, "{kind:?}");
        assert_eq!(perception.recorded_tip(0), None, "{kind:?}");
    }
    assert!(touch(ContactEstimatorKind::OneChannel, -3e-4, 1.0).1.is_some());
}
