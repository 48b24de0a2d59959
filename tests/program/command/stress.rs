//! Hard cases, and how fast runs are.

use std::process::Command;
use std::sync::Arc;

use vibrissa::built_in::{DEFAULT_POLICY, SCENARIOS};
use vibrissa::diagnostic::Source;
use vibrissa::policy::{compile, gather};
use vibrissa::report::stress_tables;
use vibrissa::report::timing_table;
use vibrissa::results::Ending;
use vibrissa::scenario;
use vibrissa::scene::WorldKind;
use vibrissa::study::stress::{Drive, StabilityCase, StressRow, StressTask, stress_cases};
use vibrissa::study::timing::{Timing, TimingRow};
use vibrissa::trial::Trial;
use vibrissa::trial::engine_version;
use vibrissa::trial::{Answer, Worker, answer};

use super::program::vibrissa;

/// Those that take no more than some hundredths of a second; `vibrissa study stress` runs them all.
#[test]
fn hard_cases_end_in_one_of_the_ways_in_which_runs_end_with_finite_numbers() {
    let mut count = 0;
    for case in stress_cases().unwrap() {
        let time = case.scene.stop.time;
        let is_quick = time <= 3.0 || case.world == WorldKind::QuasiStatic && time > 7.0 && case.drive != Drive::Policy;
        if !is_quick || !has(case.world) {
            continue;
        }
        count += 1;
        let row = case.run();
        assert!(row.is_sound(), "{row:?}");
        let StressRow::Case { name, outcome, reason, .. } = &row else { panic!("{row:?}") };
        // Whoever does not complete says why.
        assert!(*outcome == Ending::Completed || reason.is_some(), "{row:?}");
        let inside = name.contains("inside an object");
        assert!(!inside || *outcome != Ending::Completed, "{row:?}");
    }
    assert!(count > 15, "{count}");
}

#[test]
fn a_process_for_hard_cases_greets_and_answers_with_rows() {
    let all = StressTask::all().unwrap();
    let is_zero = |task: &StressTask| matches!(task, StressTask::Case(case) if case.name == "a run of 0 s");
    let zero = all.iter().position(is_zero).unwrap();
    let start = || Worker::start(Command::new(env!("CARGO_BIN_EXE_vibrissa")).arg("worker"), &engine_version());
    let mut slot = None;
    let Answer::Line(line) = answer(&mut slot, start, &zero.to_string()).unwrap() else { panic!("it ended") };
    let row: StressRow = serde_json::from_str(&line).unwrap();
    assert!(row.is_sound() && stress_tables(&[row])[0].wide().contains("a run of 0 s"));
    let Answer::Crash(reason) = answer(&mut slot, start, &all.len().to_string()).unwrap() else {
        panic!("no such case")
    };
    assert!(!all[zero].crashed(reason).is_sound());
}

#[test]
fn the_quasi_static_world_bears_every_step() {
    let cases = StabilityCase::all().into_iter().filter(|case| case.world == WorldKind::QuasiStatic);
    for case in cases.take(1) {
        let largest = case.largest_stable_step().unwrap().unwrap();
        assert!(largest > 0.03, "{}: {largest} s", case.name);
    }
}

#[test]
fn times_are_medians_of_the_runs_and_a_count_of_none_is_refused() {
    let file = SCENARIOS[0];
    let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
    let source = Source::new(DEFAULT_POLICY.path, DEFAULT_POLICY.text);
    let program = compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap();
    let trial = Trial { world: WorldKind::QuasiStatic.into(), ..Trial::new(scene, Arc::new(program)) };
    let taken = Timing::take(&trial).unwrap();
    assert!(taken.processor > 0.0 && taken.sim > 60.0 && taken.tick_mean.is_some() && taken.tick_p99.is_some());
    let runs = [1.0, 5.0, 2.0].map(|processor| Timing { processor, sim: 10.0, ..taken });
    let row = TimingRow::new("disk".to_owned(), String::new(), String::new(), &runs).unwrap();
    assert_eq!((row.runs, row.processor_s, row.realtime, row.realtime_range), (3, 2.0, 5.0, [2.0, 10.0]));
    assert!(timing_table(&[row]).wide().contains("disk"));
    assert_eq!(vibrissa(&["study", "timing", "--repeats", "0"]).status.code(), Some(2));
}

/// Whether the program has this world.
fn has(world: WorldKind) -> bool {
    world == WorldKind::QuasiStatic || cfg!(feature = "sim")
}
