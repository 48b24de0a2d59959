//! What people and programs get to see of a run.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod runs;

use std::f64::consts::TAU;

use runs::{arc_of_tips, run_with};
use vibrissa::geometry::{Contour, Point2, circle};
use vibrissa::report::{Hashes, Identity, RunResult};
use vibrissa::run::Run;
use vibrissa::scene::Outcome;
use vibrissa::score::Score;

fn disk() -> Contour {
    circle(Point2::origin(), 0.3).unwrap()
}

/// A run half round the disk of 0.3 m, a quarter of a millimetre outside of it.
fn half_round() -> Run {
    run_with(&[arc_of_tips(0.30025, 0.0, 0.5 * TAU, 0.05 / 30.0), vec![]])
}

fn result(run: &Run) -> RunResult {
    let [scenario, policy, engine] = ["5ce0", "7a11", "3a71"].map(str::to_owned);
    let identity = Identity {
        scenario: "disk".to_owned(),
        policy: "thesis".to_owned(),
        world: "mujoco".to_owned(),
        seed: 7,
        hash: Hashes { scenario, policy, engine },
    };
    RunResult::new(identity, run, &Score::new(run, &disk()))
}

fn snapshots(assert: impl FnOnce()) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots/report");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(assert);
}

/// The result as JSON in the order of its keys, with figures to a thousandth, so that they hold across machines.
fn json(result: &RunResult) -> String {
    let text = serde_json::to_string_pretty(result).unwrap();
    let rounded = text.lines().map(|line| {
        let Some((key, value)) = line.split_once(": ") else { return line.to_owned() };
        let number = value.trim_end_matches(',');
        let Ok(figure) = number.parse::<f64>() else { return line.to_owned() };
        if number.contains('.') { format!("{key}: {figure:.3}{}", &value[number.len()..]) } else { line.to_owned() }
    });
    rounded.collect::<Vec<_>>().join("\n")
}

#[test]
fn a_result_has_the_keys_of_the_command_line() {
    let mut lost = run_with(&[]);
    lost.outcome = Outcome::Failed;
    lost.reason = Some("the whisker lost the object".to_owned());
    lost.wall = std::time::Duration::ZERO;
    snapshots(|| {
        for (name, run) in [("result", half_round()), ("result_of_nothing", lost)] {
            insta::assert_snapshot!(name, json(&result(&run)));
        }
    });
}

#[test]
fn figures_that_are_no_numbers_are_null() {
    let run = run_with(&[vec![Some(Point2::new(1e300, 0.0)); 3]]);
    let json = serde_json::to_value(result(&run)).unwrap();
    assert!(json["error_mm"]["mean"].is_null());
    assert_eq!(json["error_mm"]["n"], 3);
}
