//! The loop of an admitted machine.

use vibrissa_robot::emulation::{Emulation, Injection, InjectionKind, Settings, Stopped, SwayingPlant};
use vibrissa_robot::fault::{FaultChange, FaultKind};
use vibrissa_robot::vitals::Phase;
use vibrissa_runtime::machine::{Artifact, Needs, RateRange};

use super::robot::{MACHINE, MS, admitted};

/// The robot with other needs of its machine, on a device with this longest tick (s) for a number of rounds.
fn admitted_robot(
    settings: &Settings,
    needs: Needs,
    tick: impl FnMut(u32) -> f64 + 'static,
) -> Emulation<SwayingPlant> {
    let mut artifact = Artifact::from_bytes(MACHINE).unwrap();
    artifact.program.needs = needs;
    admitted(artifact, settings, tick)
}

#[test]
fn a_loop_that_is_slower_than_configured_misses_no_period_and_has_a_value_in_every_sample() {
    let range = |low, high| Some(RateRange { low, high });
    for (control_rate, sample_rate, tick, rates) in [
        (range(20.0, 60.0), None, 0.020, (25.0, 300.0)),
        (range(20.0, 60.0), range(100.0, 250.0), 0.020, (25.0, 250.0)),
        (range(18.0, 24.0), range(60.0, 110.0), 0.0, (24.0, 96.0)),
    ] {
        let needs = Needs { control_rate, sample_rate, sample_age: None };
        let mut robot = admitted_robot(&Settings::default(), needs, move |_| tick);
        let (mut ticks, mut unknown) = (0_u32, 0);
        let stopped = robot.run(10_000 * MS, |control, _, _, _| {
            ticks += 1;
            unknown += u32::from(!control.perception().base_angle(0).is_finite());
            true
        });
        assert_eq!(stopped.unwrap(), Stopped::Time);
        assert!(robot.take_events().is_empty());
        assert_eq!(Phase::ALL.map(|phase| robot.vitals().missed(phase)), [0; Phase::ALL.len()]);
        assert_eq!(unknown, 0);
        let (control_rate, sample_rate) = rates;
        // The neutral values are the means of 300 rounds.
        let seconds = 10.0 - 300.0 / sample_rate;
        assert!((f64::from(ticks) - seconds * control_rate).abs() <= 2.0, "{ticks} ticks at {rates:?}");
        // A value is 2.6 ms old when it is read, and the tick begins 45 % of a sample period after the round.
        let age = robot.vitals().sample_age.largest_ns() as f64 * 1e-9;
        assert!((age - 0.0026 - 0.45 / sample_rate).abs() < 0.05 * age, "{age} s at {rates:?}");
    }
}

#[test]
fn a_sample_that_is_older_than_the_machine_needs_is_a_fault() {
    let detected = |age: Option<f64>| {
        let injection = Injection { at_ms: 1000, for_ms: 300, kind: InjectionKind::StaleSensor, part: 0 };
        let settings = Settings { injections: vec![injection], ..Settings::default() };
        let mut robot = admitted_robot(&settings, Needs { sample_age: age, ..Needs::default() }, |_| 0.0);
        robot.run(4000 * MS, |_, _, _, _| true).unwrap();
        let events = robot.take_events();
        let first = events.first().unwrap();
        assert_eq!((first.fault.kind, first.change), (FaultKind::SensorStale, FaultChange::Detected));
        first.time_ns - robot.begun_ns().unwrap() - 1000 * MS
    };
    // The supervisor looks every 10 ms. Before the injection, a value may be as old as a sample period.
    assert!((30 * MS..51 * MS).contains(&detected(None)));
    for age_ms in [9, 15, 25] {
        let latest_ns = (age_ms + 10) * MS;
        let detected_ns = detected(Some(age_ms as f64 * 1e-3));
        assert!(detected_ns <= latest_ns, "{detected_ns} ns for {age_ms} ms");
    }
}
