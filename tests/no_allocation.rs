//! A tick allocates nothing.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "common/allocator.rs"]
mod allocator;

use std::sync::Arc;

use allocator::allocations;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, Pose};
use vibrissa::policy::compile;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Status;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample, TrueTip};

/// Ten samples of a platform that goes straight ahead, its right whisker bent to `base_angle` (rad).
fn samples(tick: usize, base_angle: f64) -> [Sample; 10] {
    std::array::from_fn(|index| {
        let time = (tick * 10 + index) as f64 / 300.0;
        let mut whiskers = [Reading::default(); MAX_WHISKERS];
        whiskers[0].base_angle = base_angle;
        let body = Pose { position: Point2::new(0.0, 0.05 * time), heading: std::f64::consts::FRAC_PI_2 };
        Sample { time, body, whiskers }
    })
}

#[test]
fn a_tick_of_the_thesis_policy_allocates_nothing() {
    let program = compile(&Source::new("thesis.fsm", include_str!("../policies/thesis.fsm"))).unwrap();
    let mut control = Control::new(&Rig::default(), Arc::new(program)).unwrap();
    let mut seen: Vec<String> = Vec::with_capacity(8);
    for tick in 0..120 {
        // Nothing, then a touch as forward motion gives it, then one that is too strong.
        let base_angle = [0.0, -2.5e-4, -2.5e-4, -2e-3][tick / 30];
        let samples = samples(tick, base_angle);
        let before = allocations();
        let (command, given) = control.tick(&samples);
        assert_eq!(allocations() - before, 0, "tick {tick}");
        assert!(command.is_finite());
        let state = control.machine().state_name();
        assert_eq!(given.status == Status::Failed, state == "Failure");
        if seen.last().map(String::as_str) != Some(state) {
            seen.push(state.to_owned());
        }
        if tick == 80 {
            assert!(control.perception().recorded_tip(0).is_some());
        }
    }
    assert_eq!(seen, ["Searching", "Attaching", "Slipping", "Attaching", "Following", "Failure"]);
    assert!(allocations() > 0, "the count counts");
}

#[test]
fn a_tick_by_any_tip_model_allocates_nothing() {
    let text = include_str!("../policies/thesis.fsm");
    for model in ["one_channel", "sliding", "moment_and_shear", "recursive", "polynomial", "truth"] {
        let text = text.replace("by one_channel", &format!("by {model}"));
        let program = compile(&Source::new("thesis.fsm", &text)).unwrap();
        let mut rig = Rig::default();
        rig.sensing.forces = true;
        let mut control = Control::simulated(&rig, Arc::new(program)).unwrap();
        let mut told = 0;
        for tick in 0..90 {
            let base_angle = [0.0, -1.5e-4, -3e-4][tick / 30];
            let mut samples = samples(tick, base_angle);
            for sample in &mut samples {
                // The lever of a tip that is touched nearly square.
                sample.whiskers[0].shear = Some(base_angle / 0.09);
                let point_world = Point2::new(0.1, 0.02);
                sample.whiskers[0].true_tip = Some(TrueTip { point_world, touches: true });
            }
            let before = allocations();
            control.tick(&samples);
            assert_eq!(allocations() - before, 0, "{model}, tick {tick}");
            told += usize::from(control.perception().contact(0).is_some());
        }
        assert!(told > 20, "{model} tells {told}");
    }
}

#[test]
fn a_tick_among_states_in_states_allocates_nothing() {
    let program = compile(&Source::new("nested.fsm", include_str!("fixtures/charts/nested.fsm"))).unwrap();
    let mut control = Control::new(&Rig::default(), Arc::new(program)).unwrap();
    let mut seen: Vec<String> = Vec::with_capacity(64);
    for tick in 0..240 {
        // Touched and lost, again and again; then touched too strongly.
        let base_angle = if tick > 200 { -2e-3 } else { [0.0, -3e-4][tick / 15 % 2] };
        let samples = samples(tick, base_angle);
        let before = allocations();
        control.tick(&samples);
        assert_eq!(allocations() - before, 0, "tick {tick}");
        let state = control.machine().state_name();
        if seen.last().map(String::as_str) != Some(state) {
            seen.push(state.to_owned());
        }
    }
    for state in ["Exploring", "Swiping", "Searching", "Retreating"] {
        assert!(seen.iter().any(|known| known == state), "{state} of {seen:?}");
    }
}
