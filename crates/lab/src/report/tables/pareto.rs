//! Settings as a table.

use super::super::number::millimetres;
use super::super::table::{Column, Table, known};
use crate::study::pareto::{Front, Pareto, ParetoRow};

/// A table with a row for every setting. It shows whether the setting is Pareto-optimal by each error. Errors are
/// against the exact contour, against the fine run, and against the exact contour with a mismatch. Times are relative to the default. The caption states the
/// reproducibility of the fine run.
#[must_use]
pub fn pareto_table(pareto: &Pareto) -> Table {
    let floor = known(pareto.floor_mm, |floor| format!("{} mm", millimetres(floor)));
    let Pareto { policy, mismatch, .. } = pareto;
    let mismatch = mismatch.file.as_deref().unwrap_or("of the scenario");
    let ratio = |value: f64| if value < 10.0 { format!("{value:.2}") } else { format!("{value:.1}") };
    let front = |row: &ParetoRow| match row.outcome {
        ending if ending.met_its_stop() => names(row.on_front),
        ending => ending.name().to_owned(),
    };
    let columns: [Column<'_, ParetoRow>; 11] = [
        ("setting", &|row| row.setting.clone()),
        ("Pareto-optimal", &front),
        ("in its simulator", &|row| {
            if row.outcome.met_its_stop() { names(row.on_front_of_world) } else { String::new() }
        }),
        ("relative time", &|row| known(row.relative_time, ratio)),
        ("exact error mm", &|row| known(row.error_mm, millimetres)),
        ("fine error mm", &|row| known(row.fine_mm, millimetres)),
        ("mismatched error mm", &|row| match row.mismatched_outcome {
            ending if ending.met_its_stop() => known(row.mismatched_mm, millimetres),
            ending => ending.name().to_owned(),
        }),
        ("coverage", &|row| known(row.coverage, |coverage| format!("{:.1} %", 100.0 * coverage))),
        ("× real time", &|row| {
            known(row.processor_s.filter(|time| *time > 0.0), |time| format!("{:.0}", row.sim_s / time))
        }),
        ("least time", &|row| known(row.relative_time_range, |[least, _]| ratio(least))),
        ("greatest time", &|row| known(row.relative_time_range, |[_, greatest]| ratio(greatest))),
    ];
    Table::of(3, &pareto.settings, &columns).under(format!(
        "Policy {policy}, mismatch {mismatch}. A fine run that starts 1 mm farther back differs from the fine run by {floor}."
    ))
}

/// The errors by which a setting is Pareto-optimal.
fn names(front: Front) -> String {
    let Front { exact, fine, mismatched, together } = front;
    let named = [(exact, "exact"), (fine, "fine"), (mismatched, "mismatched"), (together, "together")];
    named.iter().filter_map(|(is_on, name)| is_on.then_some(*name)).collect::<Vec<_>>().join(", ")
}
