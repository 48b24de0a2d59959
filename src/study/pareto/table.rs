//! Settings as a table.

use crate::report::{NONE, ruled};
use crate::study::Ending;

use super::row::{Front, Pareto, ParetoRow};

const HEADINGS: [&str; 10] =
    ["setting", "on the front", "in its world", "time", "from", "to", "exact mm", "fine mm", "coverage", "× real time"];

/// A table, one line a setting: whether it is on the fronts of time against error, against the exact contour and against the fine run; the
/// time over that of the default, median, least and greatest; and both errors. Below it stands what the fine run can tell.
#[must_use]
pub fn pareto_table(pareto: &Pareto) -> String {
    let table = ruled(HEADINGS, pareto.settings.iter().map(cells), 3);
    let floor = pareto.floor_mm.map_or_else(|| NONE.to_owned(), |floor| format!("{floor:.4} mm"));
    format!("{table}\n\nThe fine run from a start 1 mm behind is off the fine run by {floor}.")
}

fn cells(row: &ParetoRow) -> Vec<String> {
    let shown = |value: Option<f64>, text: &dyn Fn(f64) -> String| value.map_or_else(|| NONE.to_owned(), text);
    let ratio = |value: f64| if value < 10.0 { format!("{value:.2}") } else { format!("{value:.1}") };
    let error = |error: f64| format!("{error:.4}");
    let [least, greatest] = [0, 1].map(|end| row.relative_time_range.map(|range| range[end]));
    let (front, front_of_world) = match row.outcome {
        Ending::Completed => (names(row.on_front), names(row.on_front_of_world)),
        Ending::Timeout => ("timeout", ""),
        Ending::Failed => ("failed", ""),
        Ending::Diverged => ("diverged", ""),
        Ending::Crashed | Ending::Refused => ("refused", ""),
    };
    vec![
        row.setting.clone(),
        front.to_owned(),
        front_of_world.to_owned(),
        shown(row.relative_time, &ratio),
        shown(least, &ratio),
        shown(greatest, &ratio),
        shown(row.error_mm, &error),
        shown(row.fine_mm, &error),
        shown(row.coverage, &|coverage| format!("{:.1} %", 100.0 * coverage)),
        shown(row.processor_s.filter(|time| *time > 0.0), &|time| format!("{:.0}", row.sim_s / time)),
    ]
}

fn names(front: Front) -> &'static str {
    match front {
        Front { exact: true, fine: true } => "exact, fine",
        Front { exact: true, fine: false } => "exact",
        Front { exact: false, fine: true } => "fine",
        Front { exact: false, fine: false } => "",
    }
}
