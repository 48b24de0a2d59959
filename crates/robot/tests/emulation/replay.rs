//! Replays of undamaged recordings, and of recordings whose content was changed.

use proptest::prelude::*;
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::fault::{FaultChange, FaultKind};
use vibrissa_robot::recording::{ReadError, Recording, first_stop, keep};
use vibrissa_runtime::signal::Command;

use super::campaign::schedule;
use super::recording::{records, replayed, rewritten, written};
use super::robot::{MS, robot};

/// The bits of a command.
fn bits(command: &Command) -> [u64; 3] {
    [command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits)
}

fn ticks(records: &[LoopRecord]) -> u64 {
    records.iter().filter(|record| matches!(record, LoopRecord::Tick(_))).count() as u64
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn the_replay_of_any_run_is_bit_identical(schedule in schedule()) {
        let settings = Settings { seed: schedule.seed, injections: schedule.injections, ..Settings::default() };
        let records = records(&settings, 5000);
        let replayed = replayed(&written(&settings, &records)).unwrap();
        prop_assert_eq!(replayed.difference, None);
        prop_assert!(replayed.ticks == ticks(&records) && !replayed.is_cut);
        let events = records.iter().filter_map(|record| match record {
            LoopRecord::Event(event) => Some(*event),
            _ => None,
        });
        prop_assert_eq!(replayed.events, events.collect::<Vec<_>>());
    }

    #[test]
    fn one_flipped_bit_of_a_register_is_found(
        seed in 0_u64..4, place: prop::sample::Index, board in 0_usize..2, bit in 0_u32..24,
    ) {
        let settings = Settings { seed, ..Settings::default() };
        let mut records = records(&settings, 2500);
        let rounds = records.iter_mut().filter_map(|record| match record {
            LoopRecord::Round(round) => Some(round),
            _ => None,
        });
        // Rounds after the last step are not part of the recording.
        let mut rounds: Vec<_> = rounds.collect();
        let taken = rounds.len() - 40;
        let round = &mut *rounds[place.index(taken)];
        let reading = &mut round.readings[board % usize::from(round.count)];
        prop_assume!(reading.raw.length > 0);
        reading.raw.bytes[bit as usize / 8] ^= 1 << (bit % 8);
        let is_without_meaning = bit / 8 == 0 && (1 << (bit % 8) == CORRECTED_BIT);
        let difference = replayed(&written(&settings, &records)).unwrap().difference;
        prop_assert_eq!(difference.is_none(), is_without_meaning, "{:?}", difference);
    }
}

/// The bit of the status that reports a corrected bit. It changes no reading.
const CORRECTED_BIT: u8 = 0x08;

#[test]
fn recording_changes_no_bit_of_a_command() {
    let injection = Injection { at_ms: 700, for_ms: 300, kind: InjectionKind::StaleSensor, part: 1 };
    let settings = Settings { seed: 3, injections: vec![injection], ..Settings::default() };
    // Nobody takes the records, so the queue is full after some seconds.
    let mut alone = Vec::new();
    let observe = |_: &_, command: Command, _: &_, _: &mut _| {
        alone.push(bits(&command));
        true
    };
    robot(&settings).run(9000 * MS, observe).unwrap();
    let recorded: Vec<_> = records(&settings, 9000)
        .iter()
        .filter_map(|record| match record {
            LoopRecord::Tick(tick) if !tick.is_paused => Some(bits(&tick.command)),
            _ => None,
        })
        .collect();
    assert!(alone.len() > 200 && alone == recorded);
}

#[test]
fn a_changed_command_is_reported_with_its_field() {
    let settings = Settings::default();
    let mut records = records(&settings, 3000);
    let mut ticks = records.iter_mut().filter_map(|record| match record {
        LoopRecord::Tick(tick) => Some(tick),
        _ => None,
    });
    let tick = ticks.nth(10).unwrap();
    let (time_ns, value) = (tick.started_ns, tick.command.velocity_world.x);
    tick.command.velocity_world.x = value.next_up();
    let difference = replayed(&written(&settings, &records)).unwrap().difference.unwrap();
    assert_eq!((difference.field.as_str(), difference.time_ns), ("command.x", time_ns));
    assert_eq!(difference.replayed, serde_json::to_string(&value).unwrap());
    assert_eq!(difference.recorded, serde_json::to_string(&value.next_up()).unwrap());
}

#[test]
fn lost_records_are_an_error_with_their_time() {
    let settings = Settings::default();
    let mut records = records(&settings, 3000);
    let steps = records.iter_mut().filter_map(|record| match record {
        LoopRecord::Step(step) => Some(step),
        _ => None,
    });
    steps.skip(50).for_each(|step| step.lost = 7);
    let error = replayed(&written(&settings, &records)).unwrap_err();
    assert!(matches!(error, ReadError::Lost { count: 7, .. }), "{error}");
}

#[test]
fn a_kept_recording_ends_after_the_stop_and_has_its_whole_past() {
    let injection = Injection { at_ms: 800, for_ms: 300, kind: InjectionKind::BrownOut, part: 0 };
    let settings = Settings { injections: vec![injection], ..Settings::default() };
    let file = written(&settings, &records(&settings, 6000));
    let open = || Recording::open(file.as_slice()).unwrap();
    let stop_ns = first_stop(open()).unwrap().unwrap();
    let (bytes, kept) = keep(open(), stop_ns + 500 * MS, Vec::new()).unwrap();
    let result = replayed(&bytes).unwrap();
    assert_eq!((result.difference, result.steps, result.end_ns), (None, kept.steps, kept.end_ns));
    assert!(kept.end_ns > stop_ns + 450 * MS && kept.end_ns <= stop_ns + 500 * MS && bytes.len() < file.len() / 2);
    let changes: Vec<_> = result.events.iter().map(|event| (event.fault.kind, event.change)).collect();
    assert_eq!(
        changes[..2],
        [FaultChange::Detected, FaultChange::Reacted].map(|change| (FaultKind::SensorLost, change))
    );
    assert_eq!(first_stop(Recording::open(bytes.as_slice()).unwrap()).unwrap(), Some(stop_ns));
    // A kept recording can be kept again.
    let (again, _) = keep(Recording::open(bytes.as_slice()).unwrap(), stop_ns, Vec::new()).unwrap();
    assert_eq!(replayed(&again).unwrap().difference, None);
}

#[test]
fn a_run_without_a_stop_has_no_first_stop() {
    let settings = Settings::default();
    let file = written(&settings, &records(&settings, 2000));
    assert_eq!(first_stop(Recording::open(file.as_slice()).unwrap()).unwrap(), None);
}

#[test]
fn a_recording_that_another_program_has_written_anew_replays_as_before() {
    let settings = Settings::default();
    let file = written(&settings, &records(&settings, 2000));
    let before = replayed(&file).unwrap();
    assert_eq!(before.difference, None);
    for compression in [None, Some(mcap::Compression::Lz4), Some(mcap::Compression::Zstd)] {
        let again = rewritten(&file, compression);
        let after = replayed(&again).unwrap();
        assert_eq!(
            (after.difference, after.steps, after.end_ns),
            (None, before.steps, before.end_ns),
            "{compression:?}"
        );
        assert_eq!(
            Recording::open(again.as_slice()).unwrap().identity(),
            Recording::open(file.as_slice()).unwrap().identity()
        );
        // Without its end it has no metadata.
        let cut = replayed(&again[..again.len() / 2]).unwrap_err();
        assert!(matches!(cut, ReadError::Empty), "{cut}");
    }
}
