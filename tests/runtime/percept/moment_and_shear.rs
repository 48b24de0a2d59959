//! Touches of the shaft and of the tip, found by base angle and shear: readings are made from the elastica.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use vibrissa::geometry::{Pose, Vector2, rotate, unit};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::mechanics::{Elastica, ShaftShape};
use vibrissa_runtime::percept::{Contact, Perception, PerceptionError};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

fn rig() -> Rig {
    let mut rig = Rig::default();
    rig.sensing.forces = true;
    rig
}

/// What is told of a whisker that rests in a bend, with noise by standard normal numbers.
fn told(rig: &Rig, bend: &ShaftShape, mut normal: impl FnMut() -> f64) -> (Perception, Option<Contact>) {
    let kinds = [ContactEstimatorKind::MomentAndShear];
    let mut perception = Perception::new(rig, &[Some(1)], &kinds).unwrap();
    let sensing = &rig.sensing;
    for tick in 0..9 {
        let samples: [Sample; 10] = std::array::from_fn(|index| {
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            let base_angle = bend.base_angle + sensing.angle_noise * normal();
            let shear = Some(bend.shear + sensing.force_noise * normal());
            whiskers[1] = Reading { base_angle, shear, ..Reading::default() };
            Sample { time: (tick * 10 + index) as f64 / 300.0, body: Pose::default(), whiskers }
        });
        perception.update(&samples);
        perception.record(0);
    }
    let touch = perception.contact(0).copied();
    (perception, touch)
}

/// Where a bend of the left whisker is touched (m), with the platform at the origin.
fn place(rig: &Rig, bend: &ShaftShape) -> Vector2 {
    let whisker = &rig.whiskers[1];
    let surface = bend.contact_base - whisker.shaft.radius * unit(bend.force_direction);
    whisker.base_body.coords + rotate(surface, whisker.direction_body)
}

/// Bends by touches without friction: on the shaft, or at the tip; to the left or to the right.
fn bends() -> impl Strategy<Value = ShaftShape> {
    let elastica = Elastica::new(&Rig::default().whiskers[1]);
    let on_shaft = (0.4..0.97_f64, Just(FRAC_PI_2));
    let at_tip = (Just(1.0), FRAC_PI_2 + 0.05..FRAC_PI_2 + 0.7);
    (prop_oneof![on_shaft, at_tip], 0.5..4.0_f64, any::<bool>()).prop_filter_map(
        "beyond",
        move |((share, angle), force, left)| {
            let shaft = &Rig::default().whiskers[1].shaft.clone();
            let force = force * shaft.bending_stiffness() / (shaft.length * share).powi(2);
            let bend = elastica.under(shaft.length * share, angle, 0.5 * force)?;
            let within = (1e-4..6e-4).contains(&bend.base_angle) && bend.force_direction < PI + 0.2;
            within.then(|| if left { bend } else { bend.mirrored() })
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_touch_is_found_where_it_is_and_the_shaft_is_told_from_the_tip(bend in bends()) {
        let rig = rig();
        let (perception, touch) = told(&rig, &bend, || 0.0);
        let touch = touch.unwrap();
        prop_assert!((touch.point_world.coords - place(&rig, &bend)).norm() < 1e-7);
        prop_assert!((touch.contact_length - bend.contact_length).abs() < 1e-6, "{}", touch.contact_length);
        prop_assert_eq!(touch.contact_length < 0.1 - 1e-6, bend.contact_length < 0.1);
        prop_assert_eq!(perception.recorded_tip(0), Some(touch.point_world));
    }

    #[test]
    fn another_deflection_on_the_same_surface_is_where_the_mechanics_have_it(bend in bends(), share in 0.5..1.2_f64) {
        let rig = rig();
        let (perception, touch) = told(&rig, &bend, || 0.0);
        let here = perception.tip_at(0, bend.base_angle);
        let from_base = touch.unwrap().point_world - rig.whiskers[1].base_body;
        prop_assert!((rotate(here, rig.whiskers[1].direction_body) - from_base).norm() < 1e-7);
        let elastica = Elastica::new(&rig.whiskers[1]);
        let other = elastica.solve_at(bend.contact_length, share * bend.base_angle, bend.force_direction, &bend);
        if let Some(other) = other {
            let expected = other.contact_base - rig.whiskers[1].shaft.radius * unit(other.force_direction);
            prop_assert!((perception.tip_at(0, share * bend.base_angle) - expected).norm() < 1e-6);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn the_band_that_is_told_is_that_of_the_noise(bend in bends(), seed in any::<u64>()) {
        let mut rig = rig();
        (rig.sensing.angle_noise, rig.sensing.force_noise) = (1e-6, 4e-6);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || StandardNormal.sample(&mut random);
        let (mut within, mut total) = (0, 0);
        for _ in 0..60 {
            let Some(touch) = told(&rig, &bend, &mut normal).1 else { continue };
            let off = touch.point_world.coords - place(&rig, &bend);
            let square = (off.transpose() * touch.covariance_world.try_inverse().unwrap() * off).x;
            total += 1;
            // 99 % of a normal distribution in the plane; what the mechanics may be off is in the band too, and not in the noise.
            within += i32::from(square < 9.21);
        }
        prop_assert!(total > 50 && within > 9 * total / 10, "{within} of {total}");
    }
}

#[test]
fn a_rig_that_measures_no_forces_cannot_be_perceived_so_and_the_error_says_what_to_do() {
    let error = Perception::new(&Rig::default(), &[Some(0)], &[ContactEstimatorKind::MomentAndShear]).unwrap_err();
    assert!(matches!(error, PerceptionError::NoForces { .. }));
    let text = error.to_string();
    assert!(text.contains("`r0`") && text.contains("sensing: {forces: true}"), "{text}");
}

#[test]
fn without_a_shear_or_with_one_that_no_touch_has_nothing_is_told() {
    let rig = rig();
    let elastica = Elastica::new(&rig.whiskers[1]);
    let bend = elastica.under(0.1, FRAC_PI_2, 5e-3).unwrap();
    assert!(told(&rig, &bend, || 0.0).1.is_some());
    for shear in [f64::NAN, -1.0] {
        let (perception, touch) = told(&rig, &ShaftShape { shear, ..bend }, || 0.0);
        assert_eq!((touch, perception.recorded_tip(0)), (None, None));
    }
}
