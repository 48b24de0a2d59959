//! A panic of the control thread.

use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::fault::{FaultChange, FaultKind};

use super::robot::{MS, robot};

#[test]
fn a_panic_in_the_control_step_ends_its_thread_and_another_one_stops_the_robot_within_100_ms() {
    let panics = Injection { at_ms: 1000, for_ms: 0, kind: InjectionKind::ControlPanics, part: 0 };
    let mut robot = robot(&Settings { injections: vec![panics], ..Settings::default() });
    let mut last_tick = 0.0;
    let observe = |control: &vibrissa_runtime::control::Control, _, _: &_, _: &mut _| {
        last_tick = control.perception().time();
        true
    };
    robot.run(5000 * MS, observe).unwrap();
    let injected_ns = robot.begun_ns().unwrap() + 1000 * MS;
    // The time of the machine begins with its first samples.
    assert!((0.95..1.05).contains(&last_tick), "the last tick is at {last_tick} s");
    let events = robot.take_events();
    let changes: Vec<_> = events.iter().filter(|event| event.fault.kind == FaultKind::Panic).collect();
    assert_eq!(
        changes.iter().map(|event| event.change).collect::<Vec<_>>(),
        [FaultChange::Detected, FaultChange::Reacted]
    );
    assert!(changes.iter().all(|event| (injected_ns..injected_ns + 100 * MS).contains(&event.time_ns)), "{events:?}");
    let packet = robot.last_packet().unwrap();
    assert!(packet.is_stop && packet.time_ns + 10 * MS >= robot.now_ns(), "stops are sent to the end: {packet:?}");
}

#[test]
#[should_panic(expected = "a claim about the run does not hold")]
fn a_panic_of_the_observer_is_not_one_of_the_control_thread() {
    let mut robot = robot(&Settings::default());
    robot.run(5000 * MS, |_, _, _, _| panic!("a claim about the run does not hold")).unwrap();
}
