//! Settings as a table.

use super::super::number::millimetres;
use super::super::table::{NONE, Table};
use crate::study::pareto::{Front, Pareto, ParetoRow};

const HEADINGS: [&str; 11] = [
    "setting",
    "Pareto-optimal",
    "in its world",
    "relative time",
    "exact error mm",
    "fine error mm",
    "mismatched error mm",
    "coverage",
    "× real time",
    "least time",
    "greatest time",
];

/// A table with a row for every setting. It shows whether the setting is Pareto-optimal by each error. Errors are
/// against the exact contour, against the fine run, and against the exact contour with a mismatch. Times are relative to the default. The caption states the
/// reproducibility of the fine run.
#[must_use]
pub fn pareto_table(pareto: &Pareto) -> Table {
    let floor = pareto.floor_mm.map_or_else(|| NONE.to_owned(), |floor| format!("{} mm", millimetres(floor)));
    let Pareto { policy, mismatch, .. } = pareto;
    let mismatch = mismatch.file.as_deref().unwrap_or("of the scenario");
    Table::new(3, HEADINGS, pareto.settings.iter().map(cells)).under(format!(
        "Policy {policy}, mismatch {mismatch}. A fine run that starts 1 mm farther back differs from the fine run by {floor}."
    ))
}

fn cells(row: &ParetoRow) -> Vec<String> {
    let shown = |value: Option<f64>, text: &dyn Fn(f64) -> String| value.map_or_else(|| NONE.to_owned(), text);
    let ratio = |value: f64| if value < 10.0 { format!("{value:.2}") } else { format!("{value:.1}") };
    let [least, greatest] = [0, 1].map(|end| row.relative_time_range.map(|range| range[end]));
    let (front, front_of_world) = match row.outcome {
        ending if ending.met_its_stop() => (names(row.on_front), names(row.on_front_of_world)),
        ending => (ending.name().to_owned(), String::new()),
    };
    let mismatched = match row.mismatched_outcome {
        ending if ending.met_its_stop() => shown(row.mismatched_mm, &millimetres),
        ending => ending.name().to_owned(),
    };
    vec![
        row.setting.clone(),
        front,
        front_of_world,
        shown(row.relative_time, &ratio),
        shown(row.error_mm, &millimetres),
        shown(row.fine_mm, &millimetres),
        mismatched,
        shown(row.coverage, &|coverage| format!("{:.1} %", 100.0 * coverage)),
        shown(row.processor_s.filter(|time| *time > 0.0), &|time| format!("{:.0}", row.sim_s / time)),
        shown(least, &ratio),
        shown(greatest, &ratio),
    ]
}

/// The errors by which a setting is Pareto-optimal.
fn names(front: Front) -> String {
    let Front { exact, fine, mismatched, together } = front;
    let named = [(exact, "exact"), (fine, "fine"), (mismatched, "mismatched"), (together, "together")];
    named.iter().filter_map(|(is_on, name)| is_on.then_some(*name)).collect::<Vec<_>>().join(", ")
}
