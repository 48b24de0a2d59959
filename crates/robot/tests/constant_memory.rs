//! An hour of the loop in emulated time takes constant memory.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../../../tests/common/allocator.rs"]
mod allocator;
#[path = "emulation/robot.rs"]
mod robot;

use allocator::{allocations, held};
use robot::{MS, robot};
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};

const MINUTES: u64 = 60;
const MINUTE_MS: u64 = 60_000;
/// Time between looks at the queue of records. The program has the same.
const TELEMETRY_MS: u64 = 10;

/// Faults that end again.
const FAULTS: [InjectionKind; 6] = [
    InjectionKind::NoPose,
    InjectionKind::StaleSensor,
    InjectionKind::BrownOut,
    InjectionKind::StuckBus,
    InjectionKind::SilentActuator,
    InjectionKind::ControlStalls,
];

#[test]
fn an_hour_holds_as_many_bytes_as_its_first_minute_and_allocates_none_without_a_fault() {
    // Every other minute has a fault.
    let kinds = FAULTS.into_iter().cycle();
    let fault = |(minute, kind)| Injection { at_ms: minute * MINUTE_MS + 30_000, for_ms: 500, kind, part: 1 };
    let injections: Vec<_> = (0..MINUTES).step_by(2).zip(kinds).map(fault).collect();
    let faults = injections.len();
    let mut robot = robot(&Settings { injections, ..Settings::default() });
    let (mut ticks, mut records, mut events) = (0, 0, 0);
    let mut first = None;
    for minute in 0..MINUTES {
        let before = allocations();
        for step in 1..=MINUTE_MS / TELEMETRY_MS {
            let until_ms = minute * MINUTE_MS + step * TELEMETRY_MS;
            let observe = |_: &_, _, _: &_, _: &mut _| {
                ticks += 1;
                true
            };
            robot.run(until_ms * MS, observe).unwrap();
            while let Some(record) = robot.next_record() {
                records += 1;
                if let LoopRecord::Step(step) = record {
                    assert_eq!(step.lost, 0, "the queue of records is full");
                }
            }
            events += robot.take_events().len();
        }
        assert_eq!(held(), *first.get_or_insert(held()), "bytes after minute {minute}");
        if minute % 2 == 1 {
            assert_eq!(allocations(), before, "allocations in minute {minute}");
        }
    }
    // The work has been done: a fault is detected, stops the robot and ends. Pauses take less than 2 s each.
    assert!(events >= 3 * faults, "{events} events of {faults} faults");
    assert!(ticks > 30 * 60 * MINUTES - 60 * faults as u64 - 60, "{ticks} ticks");
    assert!(records > 900 * 60 * MINUTES, "{records} records");
    assert!(held() > 0 && allocations() > 0, "the allocator counts");
}
