//! Latency of the control loop, by the phases of a policy.

use std::sync::Arc;
use std::time::Duration;

use crate::runs::run_with;
use vibrissa::built_in::{POLICIES, SCENARIOS};
use vibrissa::diagnostic::Source;
use vibrissa::geometry::Point2;
use vibrissa::policy::{compile, gather};
use vibrissa::report::latency_table;
use vibrissa::run::Run;
use vibrissa::scenario;
use vibrissa::scene::WorldKind;
use vibrissa::study::latency::LatencyRow;
use vibrissa::trial::Trial;

/// A run with a tick in each of these states, and the time (ms) that it took. `Inner` and `Innermost` are within `Outer`.
fn run(ticks: &[(Option<usize>, u64)]) -> Run {
    let mut run = run_with(&[vec![Some(Point2::origin()); ticks.len()]]);
    run.trace.states = ["Outer", "Inner", "Innermost", "Other"].map(str::to_owned).to_vec();
    run.trace.parents = vec![None, Some(0), Some(1), None];
    for (record, &(state, _)) in run.trace.ticks.iter_mut().zip(ticks) {
        record.state = state;
    }
    run.tick_times = ticks.iter().map(|&(_, time)| Duration::from_millis(time)).collect();
    run
}

fn figures(row: &LatencyRow) -> (&str, usize, [f64; 2]) {
    (&row.phase, row.ticks, [row.median, row.worst].map(|time| (1e3 * time).round()))
}

#[test]
fn ticks_count_for_the_outermost_state_and_their_times_are_medians_of_the_repetitions() {
    let states = [Some(3), Some(2), Some(1), None, Some(0), Some(2), Some(0)];
    let repetition = |times: [u64; 7]| run(&states.into_iter().zip(times).collect::<Vec<_>>());
    // The 900 ms are an interruption: the same tick is shorter in most repetitions.
    let runs =
        [repetition([7, 1, 2, 5, 9, 4, 30]), repetition([7, 900, 2, 5, 1, 4, 30]), repetition([7, 1, 1, 6, 9, 5, 30])];
    let rows = LatencyRow::of("disk", "mine", &runs);
    let found: Vec<_> = rows.iter().map(figures).collect();
    // Of `Outer`: 1, 2, 9, 4 and 30 ms.
    assert_eq!(found, [("Outer", 5, [4.0, 30.0]), ("Other", 1, [7.0, 7.0]), ("Failure", 1, [5.0, 5.0])]);
    // 30 ms of the 33.3 ms of a tick at 30 Hz.
    assert!((rows[0].share - 0.9).abs() < 1e-9 && (rows[0].longest - 0.9).abs() < 1e-9, "{:?}", rows[0]);
    let table = latency_table(&rows);
    let cells = ["5", "4000.0", "29160.0", "30000.0", "90.000", "900000.0"].map(str::to_owned);
    assert!(table.rows[0].ends_with(&cells), "{table:?}");
    assert_eq!(LatencyRow::of("disk", "mine", &[]), []);
}

#[test]
fn every_tick_of_a_run_counts_once_and_the_phases_are_states_that_no_other_contains() {
    let source = Source::new(POLICIES[0].path, POLICIES[0].text);
    let program = compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap();
    let file = SCENARIOS.iter().find(|file| file.path.ends_with("octagon.yaml")).unwrap();
    let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
    let trial = Trial { world: WorldKind::QuasiStatic.into(), ..Trial::new(scene, Arc::new(program)) };
    let run = trial.run().unwrap().run;
    let rows = LatencyRow::of("octagon", "thesis", std::slice::from_ref(&run));
    assert_eq!(rows.iter().map(|row| row.ticks).sum::<usize>(), run.trace.ticks.len());
    for LatencyRow { phase, median, p99, worst, longest, .. } in &rows {
        assert!(
            *median > 0.0 && median <= p99 && p99 <= worst && worst <= longest,
            "{phase}: {median}, {p99}, {worst}"
        );
        let state = run.trace.states.iter().position(|state| state == phase).unwrap();
        assert_eq!(run.trace.parents[state], None, "{phase}");
    }
    assert!(rows.len() > 1);
}
