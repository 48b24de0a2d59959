#![allow(clippy::unwrap_used, reason = "a test may panic")]
use proptest::prelude::*;

use super::*;
use crate::physics::Physics;
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;

fn with(property: Property, range: impl Into<Range>) -> Mismatch {
    let mut mismatch = Mismatch::default();
    mismatch.common.set(property, range);
    mismatch
}

#[test]
fn an_empty_mismatch_is_the_assumed_array() {
    let array = Mismatch::default().array(&Rig::default());
    assert_eq!(array.rig, Rig::default());
    assert_eq!(array.physics(&Physics::default()), Physics::default());
    assert!(array.is_measured_exactly() && !array.is_noisy());
}

#[test]
fn values_of_a_whisker_replace_those_of_all() {
    let mut mismatch = with(Property::Length, 1e-3);
    mismatch.whiskers.entry("l0".to_owned()).or_default().set(Property::Length, 2e-3);
    let [right, left] = [0, 1].map(|index: usize| mismatch.array(&Rig::default()).rig.whiskers[index].shaft.length);
    assert!((right - 0.101).abs() < 1e-12 && (left - 0.102).abs() < 1e-12);
}

#[test]
fn a_value_is_symmetric_for_both_sides() {
    let mut mismatch = with(Property::Direction, 0.1);
    for property in [Property::BaseForward, Property::BaseOutward, Property::TipAside] {
        mismatch.common.set(property, 1e-3);
    }
    let assumed = Rig::default();
    for (true_whisker, assumed) in mismatch.array(&assumed).rig.whiskers.iter().zip(&assumed.whiskers) {
        assert!((true_whisker.direction_body.abs() - assumed.direction_body.abs() - 0.1).abs() < 1e-12);
        assert!((true_whisker.base_body.x - assumed.base_body.x - 1e-3).abs() < 1e-12);
        assert!((true_whisker.base_body.y.abs() - assumed.base_body.y.abs() - 1e-3).abs() < 1e-12);
        let aside = true_whisker.shaft.curvature * math::square(true_whisker.shaft.length) / 2.0;
        assert!((aside - assumed.side() * 1e-3).abs() < 1e-12);
    }
}

#[test]
fn the_radius_scales_the_whole_taper_and_the_tip_radius_the_tip_alone() {
    let mut assumed = Rig::default();
    assumed.whiskers[0].shaft.tip_radius = Some(0.05e-3);
    let mut mismatch = with(Property::Radius, 0.1);
    mismatch.common.set(Property::TipRadius, -0.2);
    let rig = mismatch.array(&assumed).rig;
    let [tapered, uniform] = [0, 1].map(|whisker| &rig.whiskers[whisker].shaft);
    assert!((tapered.radius / 0.125e-3 - 1.1).abs() < 1e-12);
    assert!((tapered.tip_radius.unwrap() / 0.05e-3 - 0.88).abs() < 1e-12);
    assert!((uniform.tip_radius.unwrap() / 0.125e-3 - 0.88).abs() < 1e-12);
    assert_eq!(with(Property::Radius, 0.1).array(&assumed).rig.whiskers[1].shaft.tip_radius, None);
}

#[test]
fn a_replaced_value_is_the_true_one_and_its_logarithm_is_drawn() {
    let first_mode = Property::Rig("whiskers.*.first_mode");
    let mut mismatch = with(first_mode, Range { least: 1.0, greatest: 100.0 });
    let assumed = Rig::default();
    let mut low = 0;
    for seed in 0..2000 {
        mismatch.seed = Some(seed);
        let found = mismatch.array(&assumed).rig.whiskers[0].first_mode.unwrap();
        assert!((1.0..=100.0).contains(&found));
        low += u32::from(found < 10.0);
    }
    // Half of them, within four standard deviations of a binomial distribution.
    assert!(low.abs_diff(1000) < 90, "{low} of 2000 are below the geometric mean");
}

#[test]
fn the_servo_of_rotation_is_that_of_translation_unless_it_is_given() {
    let mut mismatch = with(Property::Servo, 0.6);
    let servos = |mismatch: &Mismatch| mismatch.array(&Rig::default()).rig.platform.servos();
    assert_eq!(servos(&mismatch).as_slice(), [0.6; 3]);
    mismatch.common.set(Property::Rig("platform.yaw_servo"), 0.02);
    assert_eq!(servos(&mismatch).as_slice(), [0.6, 0.6, 0.02]);
}

#[test]
fn softer_contacts_are_those_of_the_simulation_alone() {
    let array = with(Property::Rig("physics.contact_time"), 3.0).array(&Rig::default());
    let assumed = Physics::default();
    assert!((array.physics(&assumed).contact_time / assumed.contact_time - 4.0).abs() < 1e-12);
    assert_eq!(array.rig, Rig::default());
}

#[test]
fn friction_shortens_the_steps_of_the_simulation() {
    for (friction, least) in [(0.1, 6.0), (0.2, 12.0), (0.3, 12.0)] {
        let array = with(Property::Friction, friction).array(&Rig::default());
        let physics = array.physics(&Physics::default());
        let steps = physics.step.recip() / array.rig.sensing.sample_rate;
        assert!((physics.friction - friction).abs() < 1e-15);
        assert!(steps >= least - 1e-9 && (steps - steps.round()).abs() < 1e-9, "{friction}: {steps}");
        assert_eq!(array.rig.sensing, Rig::default().sensing, "perception does not know it");
    }
}

#[test]
fn a_mismatch_that_cannot_be_simulated_is_refused() {
    let rig = Rig::default();
    let mut other = Mismatch::default();
    other.whiskers.insert("r7".to_owned(), Ranges::default());
    assert_eq!(other.check(&rig).unwrap_err().to_string(), "the rig has no whisker `r7`; it has `r0`, `l0`");
    let short = with(Property::Length, Range { least: -0.1, greatest: 0.0 });
    let told = short.check(&rig).unwrap_err().to_string();
    assert!(told.contains("the true `length` of whisker `r0` could be 0 mm, and must be from 1 mm to 1 m"), "{told}");
    let mut light = with(Property::Links, 64.0);
    light.common.set(Property::Radius, -0.99);
    light.common.set(Property::Length, -0.05);
    assert!(matches!(light.check(&rig), Err(MismatchError::Light { .. })));
    assert_eq!(with(Property::Length, Range { least: -1e-3, greatest: 1e-3 }).check(&rig), Ok(()));
}

#[test]
fn what_is_given_precedes_what_completes_it() {
    let mut own = with(Property::Length, 1e-3);
    let mut other = with(Property::Length, 5e-3);
    other.common.set(Property::Stiffness, 0.1);
    (other.seed, other.loss, other.file) = (Some(3), Some(Loss::Stale), Some("a.yaml".to_owned()));
    own.complete(&other);
    assert_eq!(own.common.get(Property::Length), Some(1e-3.into()));
    assert_eq!(own.common.get(Property::Stiffness), Some(0.1.into()));
    assert_eq!((own.seed, own.loss, own.file.as_deref()), (Some(3), Some(Loss::Stale), Some("a.yaml")));
}

proptest! {
    #[test]
    fn drawn_values_are_in_their_range_and_do_not_depend_on_other_ranges(seed in any::<u64>()) {
        let range = Range { least: -0.5e-3, greatest: 0.5e-3 };
        let mut alone = with(Property::Length, range);
        alone.seed = Some(seed);
        let mut together = alone.clone();
        together.common.set(Property::Stiffness, Range { least: -0.1, greatest: 0.1 });
        together.common.set(Property::Servo, 0.1);
        let lengths = |mismatch: &Mismatch| {
            mismatch.array(&Rig::default()).rig.whiskers.iter().map(|whisker| whisker.shaft.length).collect::<Vec<_>>()
        };
        prop_assert_eq!(lengths(&alone), lengths(&together));
        prop_assert!(lengths(&alone).iter().all(|length| (length - 0.1).abs() <= 0.5e-3 + 1e-15));
        let [right, left] = lengths(&alone)[..] else { panic!("two whiskers") };
        prop_assert!((right - left).abs() > 0.0, "whiskers are independent");
    }
}

#[test]
fn drawn_values_are_uniform_over_seeds() {
    let mut mismatch = with(Property::Stiffness, Range { least: -0.05, greatest: 0.05 });
    let assumed = Rig::default();
    let mut shares = Vec::new();
    for seed in 0..5000 {
        mismatch.seed = Some(seed);
        let stiffness = mismatch.array(&assumed).rig.whiskers[0].shaft.young_modulus;
        shares.push((stiffness / assumed.whiskers[0].shaft.young_modulus - 0.95) / 0.1);
    }
    shares.sort_by(f64::total_cmp);
    // The largest distance of the distribution functions, which 1 of 1000 uniform samples exceeds at 1.95 / sqrt(n).
    let farthest = (0_u32..).zip(&shares).map(|(rank, share)| (f64::from(rank) / 5000.0 - share).abs());
    assert!(farthest.fold(0.0, f64::max) < 1.95 / 5000_f64.sqrt());
}
