//! The fault campaign: random schedules of faults, and their detection.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;

use proptest::prelude::*;
use proptest::test_runner::{Config as ProptestConfig, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use vibrissa_robot::config::FaultResponse;
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Emulation, Injection, InjectionKind, Settings, SwayingPlant};
use vibrissa_robot::fault::{FaultChange, FaultEvent, FaultKind};

use super::robot::{MS, robot};

/// Number of schedules, unless proptest's own variable `PROPTEST_CASES` has another one. An emulated processor needs more
/// time for each.
const SCHEDULES: u32 = 1000;
/// Number of detections that every kind must have in these schedules.
const LEAST_DETECTIONS: u32 = 30;
/// The latest stop after a fault (ns).
const STOP_NS: u64 = 100 * MS;

/// A schedule. It is shown as the YAML that `vibrissa drive --inject` reads.
#[derive(Clone)]
pub(crate) struct Schedule {
    pub(crate) seed: u64,
    pub(crate) injections: Vec<Injection>,
}

impl fmt::Debug for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let yaml = serde_yaml::to_string(&self.injections).unwrap();
        write!(f, "seed {}:\n{yaml}", self.seed)
    }
}

fn injection() -> impl Strategy<Value = Injection> {
    let kind = proptest::sample::select(InjectionKind::ALL.to_vec());
    (500_u64..3000, 150_u64..700, kind, 0_u8..2).prop_map(|(at_ms, for_ms, kind, part)| Injection {
        at_ms,
        for_ms,
        kind,
        part,
    })
}

pub(crate) fn schedule() -> impl Strategy<Value = Schedule> {
    (0_u64..1000, proptest::collection::vec(injection(), 1..4))
        .prop_map(|(seed, injections)| Schedule { seed, injections })
}

/// The four times of a fault (ns).
#[derive(Debug, Clone, Copy)]
struct Stamps {
    injected: u64,
    detected: Option<u64>,
    reacted: Option<u64>,
    recovered: Option<u64>,
}

#[test]
fn every_fault_of_random_schedules_stops_the_robot_within_100_ms() {
    let schedules = std::env::var("PROPTEST_CASES").map_or(SCHEDULES, |count| count.parse().unwrap());
    let detections: RefCell<BTreeMap<String, u32>> = RefCell::default();
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let config = ProptestConfig { cases: schedules, failure_persistence: None, ..ProptestConfig::default() };
    let result = TestRunner::new_with_rng(config, rng).run(&schedule(), |schedule| {
        for (injection, stamps) in survives(&schedule)? {
            if is_detected(injection.kind, stamps) {
                *detections.borrow_mut().entry(format!("{:?}", injection.kind)).or_default() += 1;
            }
        }
        Ok(())
    });
    if let Err(failure) = result {
        panic!("{failure}");
    }
    let detections = detections.into_inner();
    for kind in InjectionKind::ALL {
        let count = detections.get(&format!("{kind:?}")).copied().unwrap_or(0);
        let least = LEAST_DETECTIONS * schedules / SCHEDULES;
        assert!(count >= least, "{kind:?} was detected {count} times only: {detections:?}");
    }
    for kind in FaultKind::ALL {
        assert!(
            InjectionKind::ALL.iter().any(|injection| injection.expected() == Some(kind)),
            "{kind:?} is not injected"
        );
    }
}

/// True if the fault has been detected, and the robot has stopped if it stops for such a fault. One that must not be noticed counts
/// if it has not been: the schedule has been survived.
fn is_detected(kind: InjectionKind, stamps: Stamps) -> bool {
    kind.expected().is_none() || stamps.detected.is_some() && (stamps.reacted.is_some() || !stops(kind))
}

/// True if the robot stops for such a fault.
fn stops(kind: InjectionKind) -> bool {
    kind.expected().is_some_and(|fault| fault.default_response() != FaultResponse::Log)
}

/// Runs a schedule. The result has the times of every fault.
fn survives(schedule: &Schedule) -> Result<Vec<(Injection, Stamps)>, TestCaseError> {
    let injections = schedule.injections.clone();
    let mut robot = robot(&Settings { seed: schedule.seed, injections: injections.clone(), ..Settings::default() });
    let mut events = Vec::new();
    while robot.begun_ns().is_none() {
        run_to(&mut robot, &mut events, |now_ns| now_ns + 10 * MS)?;
    }
    let begun_ns = robot.begun_ns().unwrap();
    let start = |injection: &Injection| begun_ns + injection.at_ms * MS;
    let mut in_order = injections.clone();
    in_order.sort_by_key(start);
    for injection in &in_order {
        run_to(&mut robot, &mut events, |now_ns| now_ns.max(start(injection) + STOP_NS))?;
        if stops(injection.kind) {
            let is_stop = robot.last_packet().is_some_and(|packet| packet.is_stop);
            prop_assert!(is_stop, "no stop 100 ms after {injection:?}: {events:?}");
        }
    }
    let end_ns = injections.iter().map(|i| start(i) + i.for_ms * MS).max().unwrap_or(begun_ns);
    run_to(&mut robot, &mut events, |_| end_ns + 1500 * MS)?;
    let is_stop = robot.last_packet().is_none_or(|packet| packet.is_stop);
    let was_detected =
        |kind: FaultKind| events.iter().any(|event| event.fault.kind == kind && event.change == FaultChange::Detected);
    // A bent whisker is not seen while its sensor is lost. Every other fault that ends a run is.
    for kind in injections.iter().filter_map(|injection| injection.kind.expected()) {
        let ends = kind.default_response() == FaultResponse::Stop && kind != FaultKind::AngleLimit;
        prop_assert!(!ends || was_detected(kind), "{kind:?} was not detected: {events:?}");
    }
    let ending = FaultKind::ALL.into_iter().filter(|kind| kind.default_response() == FaultResponse::Stop);
    let ending: Vec<_> = ending.filter(|&kind| was_detected(kind)).collect();
    // In particular, no thread panics by itself.
    for kind in &ending {
        let was_injected = injections.iter().any(|injection| injection.kind.expected() == Some(*kind));
        prop_assert!(was_injected, "{kind:?} was not injected: {events:?}");
    }
    let has_ended = !ending.is_empty();
    prop_assert_eq!(is_stop, has_ended, "after all faults: {:?}", events);
    Ok(injections.iter().map(|injection| (*injection, stamps(injection, start(injection), &events))).collect())
}

/// Runs on until a time, and checks every packet until then.
fn run_to(
    robot: &mut Emulation<SwayingPlant>,
    events: &mut Vec<FaultEvent>,
    until: impl Fn(u64) -> u64,
) -> Result<(), TestCaseError> {
    let (until_ns, mut last) = (until(robot.now_ns()), None);
    while robot.now_ns() < until_ns {
        robot.run((robot.now_ns() + 10 * MS).min(until_ns), |_, _, _, _| true).unwrap();
        if let Some(packet) = robot.last_packet() {
            prop_assert!(packet.command.is_finite());
            prop_assert!(packet.command.velocity_world.norm() <= 1.0 + 1e-12 && packet.command.yaw_rate.abs() <= 3.2);
            prop_assert!(!packet.is_stop || packet.command == vibrissa_runtime::signal::Command::STOP);
        }
        while let Some(record) = robot.next_record() {
            let LoopRecord::Tick(report) = record else { continue };
            // Wrapped headings, displaced poses and those of a stranger never reach the machine.
            if let Some(last) = last.replace(report.pose).filter(|last| last.is_finite() && report.pose.is_finite()) {
                let (moved, turned) = (report.pose.position - last.position, report.pose.heading - last.heading);
                prop_assert!(moved.norm() < 0.5 && turned.abs() < 1.0, "from {last:?} to {:?}", report.pose);
            }
        }
    }
    events.extend(robot.take_events());
    Ok(())
}

fn stamps(injection: &Injection, injected: u64, events: &[FaultEvent]) -> Stamps {
    let kind = injection.kind.expected();
    let part = if injection.kind.concerns_a_whisker() || injection.kind == InjectionKind::StuckBus {
        injection.part
    } else {
        0
    };
    let of_kind = events.iter().filter(|event| Some(event.fault.kind) == kind && event.fault.part == part);
    let after = |change: FaultChange, from: u64| {
        of_kind.clone().find(|event| event.change == change && event.time_ns >= from).map(|event| event.time_ns)
    };
    let detected = after(FaultChange::Detected, injected).filter(|&time| time <= injected + STOP_NS);
    let reacted = detected.and_then(|time| after(FaultChange::Reacted, time));
    let recovered = reacted.and_then(|time| after(FaultChange::Recovered, time));
    Stamps { injected, detected, reacted, recovered }
}

#[test]
fn a_fault_that_ends_has_four_times_in_order() {
    let injection = Injection { at_ms: 800, for_ms: 300, kind: InjectionKind::NoPose, part: 0 };
    let times = survives(&Schedule { seed: 3, injections: vec![injection] }).unwrap();
    let [(_, Stamps { injected, detected: Some(detected), reacted: Some(reacted), recovered: Some(recovered) })] =
        times[..]
    else {
        panic!("{times:?}")
    };
    assert!(injected < detected && detected <= reacted && reacted < recovered);
    assert!(reacted - injected <= STOP_NS && recovered - injected >= 300 * MS);
}
