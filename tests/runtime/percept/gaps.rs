//! Samples that are not numbers: what is left out, what a tick without a reading feels like, and that nothing of it stays.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "a test may panic, and what is exact is compared exactly")]

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use proptest::prelude::*;
use vibrissa::geometry::{Point2, Pose};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{BodyScalar, ContactEstimatorKind, Senses, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::percept::{LowPass, Perception};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

/// Samples in a tick.
const PER_TICK: usize = 10;
/// What is no reading.
const BAD: [f64; 5] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -4.0];

fn pose(time: f64) -> Pose {
    Pose { position: Point2::new(0.0, 0.05 * time), heading: FRAC_PI_2 }
}

/// A sample of the platform on its way straight ahead, both whiskers bent by `base_angle` (rad).
fn sample(index: usize, base_angle: f64) -> Sample {
    let time = index as f64 / 300.0;
    let mut whiskers = [Reading::default(); MAX_WHISKERS];
    whiskers[0].base_angle = base_angle;
    whiskers[1].base_angle = -base_angle;
    Sample { time, body: pose(time), whiskers }
}

fn samples(base_angles: &[f64]) -> Vec<Sample> {
    base_angles.iter().enumerate().map(|(index, &angle)| sample(index, angle)).collect()
}

fn perception() -> Perception {
    Perception::new(&Rig::default(), &[Some(0), Some(1)], &[ContactEstimatorKind::OneChannel; 2]).unwrap()
}

fn filter() -> LowPass {
    let sensing = Rig::default().sensing;
    LowPass::new(sensing.filter_cutoff, sensing.sample_rate).unwrap()
}

fn feels(perception: &Perception, quantity: WhiskerScalar) -> f64 {
    Senses::whisker(perception, 0, quantity)
}

fn tip(perception: &Perception) -> Vec<f64> {
    perception.whisker_vector(0, WhiskerVector::Tip).iter().copied().collect()
}

/// Readings, and which of them are bad.
fn readings() -> impl Strategy<Value = Vec<f64>> {
    let good = prop::collection::vec(-1e-3..1e-3_f64, 3..60);
    let bad = prop::collection::vec(prop::sample::select(&BAD), 1..45);
    prop::collection::vec(prop_oneof![good, bad], 1..8).prop_map(|bursts| {
        let mut readings = bursts.concat();
        readings.resize(readings.len().next_multiple_of(PER_TICK), 5e-4);
        readings
    })
}

/// What the deflection should be at the end of every tick, written down as what it is defined to be: the filter of the
/// readings, each bad one replaced by the last good one, begun anew after a tick without any.
fn due(readings: &[f64]) -> Vec<Option<f64>> {
    let is_good = |reading: &f64| reading.abs() <= PI;
    let (mut heard, mut due): (Vec<f64>, Vec<Option<f64>>) = (Vec::new(), Vec::new());
    let mut origin = 0.0;
    for tick in readings.chunks(PER_TICK) {
        let Some(first) = tick.iter().position(is_good) else {
            due.push(None);
            continue;
        };
        let (mut tick, mut last) = (tick, heard.last().copied().unwrap_or(origin));
        if due.last() == Some(&None) {
            heard.clear();
            (origin, last, tick) = (tick[first], tick[first], &tick[first..]);
        }
        for reading in tick {
            last = if is_good(reading) { *reading } else { last };
            heard.push(last);
        }
        let mut filter = filter();
        due.push(heard.iter().map(|reading| filter.next(reading - origin)).last().map(|value| value + origin));
    }
    due
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_bad_reading_is_replaced_by_the_last_good_one_and_a_tick_without_any_has_no_deflection(readings in readings()) {
        let mut perception = perception();
        for (tick, due) in samples(&readings).chunks(PER_TICK).zip(due(&readings)) {
            perception.update(tick);
            let deflection = perception.base_angle(0);
            if let Some(due) = due {
                prop_assert!((deflection - due).abs() < 1e-12, "{deflection} {due}");
            } else {
                    prop_assert!(deflection.is_nan() && tip(&perception).iter().all(|part| part.is_nan()));
                    let truths = [WhiskerScalar::Touching, WhiskerScalar::Sense].map(|truth| feels(&perception, truth));
                    prop_assert_eq!(truths, [0.0; 2]);
            }
        }
    }

    #[test]
    fn after_a_gap_a_whisker_feels_at_once_what_is_there(before in -1e-3..1e-3_f64, after in -1e-3..1e-3_f64, gap in 1..90_usize) {
        let mut perception = perception();
        let readings = [vec![before; 300], vec![f64::NAN; gap * PER_TICK], vec![after; PER_TICK]].concat();
        samples(&readings).chunks(PER_TICK).for_each(|tick| perception.update(tick));
        prop_assert!((perception.base_angle(0) - after).abs() < 1e-15);
    }
}

#[test]
fn what_does_not_depend_on_a_reading_is_known_without_it() {
    let mut perception = perception();
    perception.update(&samples(&[f64::NAN; PER_TICK]));
    assert!(perception.pose().is_finite() && feels(&perception, WhiskerScalar::Yaw).is_finite());
    assert!(perception.whisker_vector(0, WhiskerVector::Base).iter().all(|part| part.is_finite()));
    assert!(perception.tip_at(0, 3e-4).iter().all(|part| part.is_finite()));
    assert_eq!(feels(&perception, WhiskerScalar::ContourReady), 0.0);
    assert!(perception.whisker_vector(0, WhiskerVector::ContourTangent).iter().all(|part| part.is_nan()));
}

#[test]
fn a_contour_that_was_left_off_is_not_ready_and_can_be_read_until_its_whisker_is_recorded_again() {
    let mut perception = perception();
    let ready = |perception: &Perception| feels(perception, WhiskerScalar::ContourReady) > 0.5;
    let tangent = |perception: &Perception| perception.whisker_vector(0, WhiskerVector::ContourTangent);
    for (index, tick) in samples(&[3e-4; 90 * PER_TICK]).chunks(PER_TICK).enumerate() {
        perception.update(tick);
        match index {
            // The filter has settled, and there are seven points.
            20..40 => assert!(ready(&perception), "tick {index}"),
            // The tick before recorded.
            40 => assert!(ready(&perception)),
            41..=60 => {
                assert!(!ready(&perception), "tick {index}");
                assert!((tangent(&perception).y - 1.0).abs() < 1e-3, "tick {index}");
            }
            61 => assert!(!ready(&perception) && tangent(&perception).x.is_nan(), "it begins anew"),
            _ => {}
        }
        if !(40..60).contains(&index) {
            perception.record(0);
        }
    }
    assert!(ready(&perception));
}

#[test]
fn a_state_that_is_entered_anew_waits_for_a_contour_of_its_own() {
    let text = "machine m whisker r0 by one_channel initial Recording
        state Recording { record r0 stop after 1 s -> Pausing }
        state Pausing { stop after 0.3 s -> Again }
        state Again { record r0 stop when r0.contour.ready -> Left }
        state Left { record r0 stop }";
    let program = Arc::new(crate::common::program(text));
    let mut control = Control::new(&Rig::default(), program).unwrap();
    let mut ticks_in = [0; 4];
    for tick in samples(&[3e-4; 90 * PER_TICK]).chunks(PER_TICK) {
        control.tick(tick);
        ticks_in[control.machine().state()] += 1;
    }
    // The tip goes 1.67 mm in a tick, so that every tick has a point: seven of them, and the next tick leaves the state.
    assert_eq!(ticks_in[..3], [30, 9, 7], "{ticks_in:?}");
}

#[test]
fn of_poses_and_times_that_are_none_the_newest_other_counts() {
    let mut perception = perception();
    let mut tick = samples(&[3e-4; PER_TICK]);
    for sample in &mut tick[4..] {
        sample.body.heading = f64::NAN;
        sample.time = f64::INFINITY;
    }
    perception.update(&tick);
    assert_eq!((perception.pose(), perception.time()), (tick[3].body, tick[3].time));
    for sample in &mut tick {
        sample.body.position.x = f64::NEG_INFINITY;
    }
    perception.update(&tick[4..]);
    assert!(perception.body(BodyScalar::Yaw).is_nan() && tip(&perception)[0].is_nan());
    assert_eq!(perception.time(), tick[3].time, "the time stands still");
    assert!(feels(&perception, WhiskerScalar::Touching) > 0.5, "the reading is as good as ever");
}

#[test]
fn a_pose_that_is_none_leaves_no_point_in_a_contour() {
    let mut perception = perception();
    let all = samples(&[3e-4; 40 * PER_TICK]);
    for (index, tick) in all.chunks(PER_TICK).enumerate() {
        let mut tick = tick.to_vec();
        if (20..25).contains(&index) {
            for sample in &mut tick {
                sample.body = Pose::UNKNOWN;
            }
        }
        perception.update(&tick);
        perception.record(0);
        let end = perception.whisker_vector(0, WhiskerVector::ContourEnd);
        assert!(end.iter().all(|part| part.is_finite()), "tick {index}");
        let ready = feels(&perception, WhiskerScalar::ContourReady) > 0.5;
        let tangent = perception.whisker_vector(0, WhiskerVector::ContourTangent);
        // The platform goes up the y axis. The filter has settled by then.
        assert_eq!(ready, tangent.norm().is_finite());
        assert!(!ready || index < 15 || (tangent.y - 1.0).abs() < 1e-3, "tick {index}: {tangent}");
    }
}

/// Policies that compute with all that can go wrong, and go on whatever does.
fn policies() -> [String; 2] {
    let resting = "initial Exploring failsafe -> Resting state Resting { stop after 0.2 s -> Exploring }";
    let mut thesis = include_str!("../../../policies/thesis.fsm").replace("initial Exploring", resting);
    while let Some(start) = thesis.find("Failure(") {
        let end = start + thesis[start..].find(')').unwrap();
        thesis.replace_range(start..=end, "Resting");
    }
    let computing = "machine computing whisker r0, l0 initial Go failsafe -> Still
        law go(w: whisker) {
          let bend = lowpass(w.base_angle, 5 Hz)
          let pull = pid(turn(body.yaw, angle(w.tip - w.base)), 2 Hz, 0.5 Hz^2, 0.1, 1 rad/s)
          steer w along w.tip_at(bend) / w.base_angle at 50 mm/s * min(1, |w.tip - body.position| / 1 m) turning pull
        }
        state Go { record r0 do go(r0) after 1 s -> Other }
        state Other { record l0 do go(l0) after 0.5 s -> Go failsafe -> Still }
        state Still { stop when r0.base_angle == r0.base_angle for 50 ms -> Go }";
    [thesis, computing.to_owned()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn no_burst_gives_a_command_that_is_not_finite_or_stays(
        which in 0..2_usize, readings in readings(), poses in prop::collection::vec((0..400_usize, 1..40_usize, 0..4_u8), 0..4),
    ) {
        let program = Arc::new(crate::common::program(&policies()[which]));
        let mut control = Control::new(&Rig::default(), program).unwrap();
        let mut all = samples(&[readings, vec![-3e-4; 120 * PER_TICK]].concat());
        for (start, length, coordinate) in poses {
            for sample in all.iter_mut().skip(start).take(length) {
                match coordinate {
                    0 => sample.body.position.x = f64::NAN,
                    1 => sample.body.position.y = f64::INFINITY,
                    2 => sample.body.heading = f64::NAN,
                    _ => sample.time = f64::NAN,
                }
            }
        }
        let ticks = all.len() / PER_TICK;
        let mut moving = 0;
        for (index, tick) in all.chunks(PER_TICK).enumerate() {
            let (command, given) = control.tick(tick);
            prop_assert!(command.is_finite(), "{command:?}");
            // Bursts end long before the last second: by then nothing of them is left.
            if index + 30 >= ticks {
                prop_assert!(given.fallback.is_none() && control.machine().failure().is_none(), "tick {index}");
                moving += usize::from(command.velocity_world.norm() > 1e-3);
            }
        }
        prop_assert!(moving > 0);
        prop_assert!((control.perception().base_angle(0) + 3e-4).abs() < 1e-9);
    }
}

/// A policy whose commands need the base angle, the tip and the pose.
const NEEDY: &str = "machine m whisker r0 by one_channel initial Going failsafe -> Waiting
    state Going { steer body along direction(body.yaw) + unit(r0.tip - body.position) at 0.1 mm/s / 1 urad * |r0.base_angle| turning 0 deg/s }
    state Waiting { stop }";

/// The states of [`NEEDY`] after every tick, under these samples.
fn states(samples: &[Sample]) -> Vec<usize> {
    let mut control = Control::new(&Rig::default(), Arc::new(crate::common::program(NEEDY))).unwrap();
    let mut tick = |tick: &[Sample]| {
        let (command, _) = control.tick(tick);
        assert!(command.is_finite() && control.machine().failure().is_none());
        control.machine().state()
    };
    samples.chunks(PER_TICK).map(&mut tick).collect()
}

#[test]
fn a_machine_keeps_its_values_over_a_short_gap_and_takes_its_fallback_in_a_long_one() {
    for spoil in [
        (|sample: &mut Sample| sample.whiskers[0].base_angle = f64::NAN) as fn(&mut Sample),
        |sample| sample.body = Pose::UNKNOWN,
        |sample| (sample.body, sample.whiskers[0].base_angle) = (Pose::UNKNOWN, f64::INFINITY),
    ] {
        let mut all = samples(&[3e-4; 60 * PER_TICK]);
        all[20 * PER_TICK..22 * PER_TICK].iter_mut().for_each(spoil);
        all[40 * PER_TICK..].iter_mut().for_each(spoil);
        let states = states(&all);
        assert!(states[..42].iter().all(|&state| state == 0), "{states:?}");
        assert!(states[44..].iter().all(|&state| state == 1), "{states:?}");
    }
}

#[test]
fn without_any_sample_values_are_not_kept_for_ever() {
    let mut control = Control::new(&Rig::default(), Arc::new(crate::common::program(NEEDY))).unwrap();
    for tick in samples(&[3e-4; 10 * PER_TICK]).chunks(PER_TICK) {
        control.tick(tick);
    }
    let states: Vec<usize> = (0..6)
        .map(|_| {
            control.tick(&[]);
            control.machine().state()
        })
        .collect();
    assert!(states[..2] == [0, 0] && states[4..] == [1, 1], "{states:?}");
}

#[test]
fn a_kept_value_records_no_tip_and_a_machine_without_readings_from_the_start_has_none() {
    let text = "machine m whisker r0 by one_channel initial Going state Going { record r0 stop }";
    let program = Arc::new(crate::common::program(text));
    let mut control = Control::new(&Rig::default(), Arc::clone(&program)).unwrap();
    let mut all = samples(&[3e-4; 33 * PER_TICK]);
    all[31 * PER_TICK..].iter_mut().for_each(|sample| sample.whiskers[0].base_angle = f64::NAN);
    for (index, tick) in all.chunks(PER_TICK).enumerate() {
        control.tick(tick);
        let perception = control.perception();
        assert!(perception.base_angle(0).is_finite(), "tick {index}");
        if index > 25 {
            assert_eq!(perception.recorded_tip(0).is_some(), index < 31, "tick {index}");
        }
    }
    let mut control = Control::new(&Rig::default(), program).unwrap();
    control.tick(&samples(&[f64::NAN; PER_TICK]));
    assert!(control.perception().base_angle(0).is_nan());
}
