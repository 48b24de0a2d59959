//! True tips as an ideal sensor.

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, Pose};
use vibrissa::policy::compile_with_warnings;
use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::machine::{Artifact, ContactEstimatorKind, Senses, WhiskerVector};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample, TrueTip};

/// A sample in which the right whisker has this base angle (rad) and this true tip.
fn sample(time: f64, base_angle: f64, true_tip: Option<TrueTip>) -> Sample {
    let mut whiskers = [Reading::default(); MAX_WHISKERS];
    whiskers[0] = Reading { base_angle, true_tip, ..Reading::default() };
    Sample { time, body: Pose { position: Point2::new(0.3, -0.2), heading: 0.7 }, whiskers }
}

/// A perception after some ticks in which the newest of ten samples has a true tip.
fn told(base_angle: f64, true_tip: Option<TrueTip>) -> Perception {
    let mut perception = Perception::new(&Rig::default(), &[Some(0)], &[ContactEstimatorKind::Truth]).unwrap();
    for tick in 0..10 {
        let samples: [Sample; 10] = std::array::from_fn(|index| {
            let time = (tick * 10 + index) as f64 / 300.0;
            sample(time, base_angle, true_tip.filter(|_| index == 9))
        });
        perception.update(&samples);
        perception.record(0);
    }
    perception
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_contact_is_the_true_tip_while_the_tip_touches(
        (x, y) in (-1.0..1.0_f64, -1.0..1.0_f64), base_angle in 5e-5..6e-4_f64, touches in any::<bool>(),
    ) {
        let point_world = Point2::new(x, y);
        let mut perception = told(-base_angle, Some(TrueTip { point_world, touches }));
        let there = touches.then_some(point_world);
        prop_assert_eq!(perception.contact(0).map(|contact| contact.point_world), there);
        prop_assert_eq!(perception.recorded_tip(0), there);
        // At the present base angle, the tip is where it is; at others it moves as on a surface parallel to the heading.
        let tip_base = perception.whisker_vector(0, WhiskerVector::TipBase);
        let now = perception.base_angle(0);
        prop_assert!((perception.tip_at(0, now) - tip_base).norm() < 1e-12);
        // A tick without a valid reading has no contact.
        perception.update(&[sample(1.0, f64::NAN, None)]);
        prop_assert_eq!(perception.contact(0), None);
    }
}

#[test]
fn without_true_tips_there_is_no_contact() {
    let perception = told(-3e-4, None);
    assert_eq!((perception.contact(0), perception.recorded_tip(0)), (None, None));
}

/// A policy with this contact estimator.
fn artifact(estimator: &str) -> Artifact {
    let text = format!(
        "machine a  whisker l0, r0 by {estimator}  initial Up\n\
         state Up {{ record r0  steer body along vector(0, 1) at 5 cm/s facing 90 deg }}"
    );
    compile_with_warnings(&Source::new("a.fsm", text)).unwrap().artifact
}

#[test]
fn a_policy_by_truth_is_a_valid_artifact_that_runs_in_a_simulator_and_is_refused_elsewhere() {
    let artifact = artifact("truth");
    let read = Artifact::from_bytes(&artifact.to_bytes().unwrap()).unwrap();
    assert_eq!(read.program.contact_estimators, [ContactEstimatorKind::Truth; 2]);
    let program = Arc::new(read.program);
    assert!(Control::simulated(&Rig::default(), Arc::clone(&program)).is_ok());
    let error = Control::new(&Rig::default(), program).unwrap_err();
    assert!(matches!(&error, BindError::OnlySimulated(refusal) if refusal.whisker == "l0"));
    let text = error.to_string();
    assert!(
        text.contains("truth for whisker `l0`, which only a simulator has; write another one after `by`"),
        "{text}"
    );
}

#[test]
fn a_policy_by_any_other_estimator_runs_on_a_robot() {
    let mut rig = Rig::default();
    rig.sensing.forces = true;
    for kind in ContactEstimatorKind::ALL {
        assert_eq!(Control::new(&rig, Arc::new(artifact(kind.name()).program)).is_ok(), !kind.is_ideal(), "{kind:?}");
    }
}
