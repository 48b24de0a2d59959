//! Whiskers that a rig may lack: one that it lacks is as one that nothing touches, and no other whisker feels the difference.

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, Pose, Vector2};
use vibrissa::scenario;
use vibrissa::scene::WorldKind;
use vibrissa::trial::Trial;
use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::machine::{Action, ContactEstimatorKind, Mover, Senses, Turn, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::motion::Steering;
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample};

use crate::common::program;

/// A policy for a whisker; between its lines stands what asks for feelers as well.
fn policy(whiskers: &str, rule: &str) -> String {
    format!(
        "machine m whisker r0 {whiskers} initial A
        state A {{ steer r0 along direction(body.yaw + r0.base_angle * 1000) at 50 mm/s turning 0 deg/s  {rule}
          when r0.touching -> B }}
        state B {{ record r0  steer body along r0.tip - body.position at 20 mm/s facing r0.yaw  {rule}
          when not r0.touching for 100 ms -> A }}
        state C {{ stop }}"
    )
}

const FEELERS: &str = "whisker fr, fl by sliding if fitted";

/// A tick's samples of a rig of two whiskers, bent by these angles (rad).
fn samples(tick: usize, base_angles: [f64; 2]) -> Vec<Sample> {
    let sample = |index: usize| {
        let time = index as f64 / 300.0;
        let mut whiskers = [Reading::default(); MAX_WHISKERS];
        for (whisker, base_angle) in whiskers.iter_mut().zip(base_angles) {
            whisker.base_angle = base_angle;
        }
        Sample { time, body: Pose { position: Point2::new(0.0, 0.05 * time), heading: 1.2 + 0.1 * time }, whiskers }
    };
    (10 * tick..10 * (tick + 1)).map(sample).collect()
}

fn control(rig: &Rig, text: &str) -> Control {
    Control::new(rig, Arc::new(program(text))).unwrap()
}

fn ticks() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let angle = || prop_oneof![Just(0.0), -8e-4..8e-4_f64, Just(f64::NAN)];
    prop::collection::vec([angle(), angle()], 1..30)
}

proptest! {
    #[test]
    fn a_policy_does_on_a_rig_without_feelers_what_it_does_if_it_asks_for_none(
        ticks in ticks(),
        rule in prop::sample::select(vec![
            "when fr.touching or fl.touching -> C", "when fr.fitted -> C", "when fl.sense != 0 -> C",
            "when |fr.base_angle| + |fl.base_angle| > 0 rad -> C", "when fr.contour.ready -> C", "record fr mark lost fl",
        ]),
    ) {
        let rig = Rig::default();
        let (mut with, mut without) = (control(&rig, &policy(FEELERS, rule)), control(&rig, &policy("", "")));
        for (tick, &angles) in ticks.iter().enumerate() {
            let samples = samples(tick, angles);
            prop_assert_eq!(with.tick(&samples).0, without.tick(&samples).0);
            prop_assert_eq!(with.machine().state_name(), without.machine().state_name());
            prop_assert_eq!(with.perception().recorded_tip(0), without.perception().recorded_tip(0));
        }
    }

    #[test]
    fn a_whisker_that_the_rig_has_is_felt_as_if_it_had_to_be_there(ticks in ticks(), bound in 0..2_usize) {
        let rig = Rig::default();
        let (name, other) = [("r0", "l0"), ("l0", "r0")][bound];
        let text = |ending: &str| format!(
            "machine m whisker {other} whisker {name} {ending} initial A
            state A {{ record {name} steer {name} along {name}.tip - {other}.base at 10 mm/s facing {name}.base_angle * 1000 }}"
        );
        let (mut one, mut another) = (control(&rig, &text("if fitted")), control(&rig, &text("")));
        for (tick, &angles) in ticks.iter().enumerate() {
            let samples = samples(tick, angles);
            prop_assert_eq!(one.tick(&samples).0, another.tick(&samples).0);
        }
        prop_assert!(one.perception().whisker(1, WhiskerScalar::Fitted) > 0.5);
    }

    #[test]
    fn to_steer_a_whisker_that_is_not_there_is_to_steer_the_body(heading in -4.0..4.0_f64, rate in -2.0..2.0_f64, speed in 0.0..0.3_f64) {
        let mut steering = Steering::new(&Rig::default(), &[Some(0), None]);
        let body = Pose { position: Point2::new(0.3, -0.7), heading };
        let mut steer = |mover| -> Command {
            let along_world = Vector2::new(0.6, -0.8);
            steering.command(&Action::Steer { mover, along_world, speed, turn: Turn::Rate(rate) }, body)
        };
        let (whisker, itself) = (steer(Mover::Whisker(1)), steer(Mover::Body));
        prop_assert!((whisker.velocity_world - itself.velocity_world).norm() < 1e-12);
        prop_assert!((whisker.yaw_rate - itself.yaw_rate).abs() < 1e-12);
    }
}

#[test]
fn a_whisker_that_is_not_there_is_at_rest_on_the_body_along_its_heading() {
    let kinds = [ContactEstimatorKind::Sliding, ContactEstimatorKind::MomentAndShear];
    let mut perception = Perception::new(&Rig::default(), &[Some(0), None], &kinds).unwrap();
    for tick in 0..3 {
        // Its place among the readings belongs to another.
        perception.update(&samples(tick, [f64::NAN, 7e-4]));
        perception.record(1);
        let pose = perception.pose();
        for quantity in [
            WhiskerScalar::BaseAngle,
            WhiskerScalar::Touching,
            WhiskerScalar::Sense,
            WhiskerScalar::ContourReady,
            WhiskerScalar::Fitted,
        ] {
            assert!(perception.whisker(1, quantity).abs() < 1e-15, "{quantity:?}");
        }
        assert!((perception.whisker(1, WhiskerScalar::Yaw) - pose.heading).abs() < 1e-12);
        assert!((perception.whisker_vector(1, WhiskerVector::Base) - pose.position.coords).norm() < 1e-12);
        let tip_world = pose.point_to_world(Point2::new(0.1, 0.0));
        assert!((perception.whisker_vector(1, WhiskerVector::Tip) - tip_world.coords).norm() < 1e-3);
        assert_eq!(perception.recorded_tip(1), None);
    }
    assert_eq!(perception.fitted().collect::<Vec<_>>(), [(0, 0)]);
}

#[test]
fn a_rig_may_lack_no_other_whisker() {
    let bind = |text: &str| Control::new(&Rig::default(), Arc::new(program(text))).map(drop);
    let state = "initial A state A { stop when fr.touching or x.touching -> Failure(\"felt\") }";
    assert_eq!(bind(&format!("machine m whisker fr if fitted whisker x if fitted {state}")), Ok(()));
    for text in ["whisker fr if fitted whisker x", "whisker x whisker fr if fitted"] {
        let fault = bind(&format!("machine m {text} {state}")).unwrap_err();
        assert!(matches!(&fault, BindError::Whisker(_)) && fault.to_string().contains("`x`"), "{fault}");
    }
}

#[test]
fn a_trace_has_the_whiskers_that_the_rig_has() {
    let text = "name: t\nobjects: [{circle: {centre: [0.4 m, 0.4 m], radius: 0.3 m}}]\n\
        start: {position: [0 m, 72 mm], heading: 90 deg}\nstop: {time: 6 s}\n";
    let rig = "rig: {whiskers: {fr: {base: [100 mm, -14 mm], direction: -30 deg, length: 75 mm}, r0: {}, l0: {}}}\n";
    let policy = "machine m whisker fr if fitted whisker r0 initial A
        state A { record r0 mark lost r0 steer body along direction(body.yaw) at 50 mm/s turning 0 deg/s
          when fr.touching -> Failure(\"felt ahead\") }";
    let run = |text: &str| {
        let scene = scenario::read(&Source::new("t.yaml", text)).unwrap();
        let program = Arc::new(program(policy));
        Trial { world: WorldKind::QuasiStatic.into(), seed: 0, ..Trial::new(scene, program) }.run().unwrap().run.trace
    };
    let (plain, with) = (run(text), run(&format!("{text}{rig}")));
    assert_eq!(
        (plain.whiskers.as_slice(), with.whiskers.as_slice()),
        (&["r0".to_owned()][..], &["fr".to_owned(), "r0".to_owned()][..])
    );
    assert!(plain.marks.iter().all(|mark| mark.whisker == 0) && with.marks.iter().all(|mark| mark.whisker == 1));
    let same = plain.ticks.iter().zip(&with.ticks);
    assert!(same.clone().count() > 100);
    for (one, other) in same {
        assert_eq!(
            (one.body, one.whiskers[0].tip, one.whiskers[0].deflection),
            (other.body, other.whiskers[1].tip, other.whiskers[1].deflection)
        );
    }
    assert!(plain.ticks.iter().any(|tick| tick.whiskers[0].tip.is_some()));
}
