//! The table of tip models.

use vibrissa::study::estimators::{EstimatorRow, estimators_table};

fn row(scenario: &str, noise: f64, model: &'static str, mean_mm: Option<f64>) -> EstimatorRow {
    EstimatorRow {
        scenario: scenario.to_owned(),
        noise,
        model,
        told: if mean_mm.is_some() { 0.75 } else { 0.0 },
        mean_mm,
        p95_mm: mean_mm.map(|mean| 2.0 * mean),
        within_band: mean_mm.map(|_| 0.5),
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
    let table = estimators_table(&rows);
    let line = |start: &str, noise: &str| {
        let found = table.lines().find(|line| line.trim_start().starts_with(start) && line.contains(noise));
        found.unwrap_or_else(|| panic!("no {start}, {noise} in\n{table}")).to_owned()
    };
    assert!(line("disk", "none").contains("0.050, 0.10 | 75 %"), "{table}");
    assert!(line("box", "none").contains("1.00, 2.00 | 75 %"), "{table}");
    // A model that tells nothing has no error, and its share is told.
    assert!(line("disk", "10 ×").contains('–'), "{table}");
    let mean = line("sliding", "none");
    assert!(mean.contains("0.10") && mean.contains("0.20") && mean.contains("50.0 %"), "{mean}");
    assert!(line("sliding", "10 ×").contains("0.0 %"), "{table}");
}
