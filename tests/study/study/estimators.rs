//! Tip models against each other, and their table.

use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::policy::compile;
use vibrissa::report::estimators_tables;
use vibrissa::scenario;
use vibrissa::scene::WorldKind;
use vibrissa::study::estimators::{EstimatorRow, evaluate_all};
use vibrissa_runtime::machine::ContactEstimatorKind;

/// Goes up, and nearer to the wall on the right.
const POLICY: &str = "machine a  whisker r0  initial Up
state Up { record r0  steer body along vector(1, 3) at 5 cm/s facing 90 deg }";

fn row(scenario: &str, noise: f64, model: &'static str, mean_mm: Option<f64>) -> EstimatorRow {
    EstimatorRow {
        scenario: scenario.to_owned(),
        calibration: None,
        noise,
        model,
        reported: if mean_mm.is_some() { 0.75 } else { 0.0 },
        mean_mm,
        p95_mm: mean_mm.map(|mean| 2.0 * mean),
        within_band: mean_mm.map(|_| 0.5),
        outliers: mean_mm.map(|_| 0.01),
        tips: if mean_mm.is_some() { 100 } else { 0 },
        on_shaft: 0.1,
        tick_us: 4.0,
    }
}

#[test]
fn every_scene_and_noise_has_a_line_and_every_model_a_mean_over_the_scenes() {
    let rows = [
        row("disk", 0.0, "sliding", Some(0.05)),
        row("disk", 10.0, "sliding", None),
        row("box", 0.0, "sliding", Some(0.15)),
        row("box", 0.0, "one_channel", Some(1.0)),
    ];
    let table = estimators_tables(&rows).map(|table| table.wide()).concat();
    let line = |start: &str, noise: &str| {
        let found = table.lines().find(|line| line.trim_start().starts_with(start) && line.contains(noise));
        found.unwrap_or_else(|| panic!("no {start}, {noise} in\n{table}")).to_owned()
    };
    assert!(line("disk", "none").contains("0.050"), "{table}");
    assert!(line("box", "none").contains("1.00"), "{table}");
    // A model that tells nothing has no error, and its share is told.
    assert!(line("disk", "10 ×").contains('–'), "{table}");
    let mean = line("sliding", "none");
    assert!(mean.contains("0.10") && mean.contains("0.20") && mean.contains("50.0 %"), "{mean}");
    assert!(line("sliding", "10 ×").contains("0.0 %"), "{table}");
}

#[test]
fn all_models_meet_the_same_touches_in_the_world_that_is_asked_for_whatever_the_rigs_noise() {
    let scene = |noise: &str| {
        let text = format!(
            "name: wall\nrig: {{sensing: {{angle_noise: {noise}}}}}\n\
             objects: [{{polygon: {{vertices: [[128 mm, -1 m], [2 m, -1 m], [2 m, 1 m], [128 mm, 1 m]]}}}}]\n\
             start: {{position: [0 m, 0 m], heading: 90 deg}}\nstop: {{time: 2 s}}\n"
        );
        scenario::read(&Source::new("wall.yaml", text)).unwrap()
    };
    let program = Arc::new(compile(&Source::new("a.fsm", POLICY)).unwrap());
    let judged = |noise: &str| evaluate_all(&scene(noise), Arc::clone(&program), WorldKind::QuasiStatic).unwrap();
    let rows = judged("0 urad");
    assert_eq!(rows.len(), 3 * ContactEstimatorKind::ALL.len());
    let of = |model: &str, is: fn(f64) -> bool| rows.iter().find(|row| row.model == model && is(row.noise)).unwrap();
    // The surface is parallel to the heading, as models take it to be that do not know; but the bend grows, and the filter is late.
    for kind in ContactEstimatorKind::ALL {
        let (clean, loud) = (of(kind.name(), |noise| noise <= 0.0), of(kind.name(), |noise| noise > 1.0));
        assert!(clean.reported > 0.9 && clean.mean_mm.unwrap() < 0.5, "{clean:?}");
        if kind.is_ideal() {
            assert!(loud.mean_mm == clean.mean_mm && clean.mean_mm.unwrap() < 1e-3, "{loud:?}");
        } else {
            assert!(loud.mean_mm.unwrap() > clean.mean_mm.unwrap(), "{loud:?}");
        }
    }
    // The noise is what is told, not the rig's own on top.
    let timeless =
        |rows: Vec<EstimatorRow>| rows.into_iter().map(|row| EstimatorRow { tick_us: 0.0, ..row }).collect::<Vec<_>>();
    assert_eq!(timeless(judged("5 urad")), timeless(rows.clone()));
}
