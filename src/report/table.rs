//! Results as a table for the terminal.

use comfy_table::{Cell, CellAlignment, LineStyle, Table, TableStyle};

use super::number::{mean_std, millimetres};
use super::{MeanStd, RunResult};

/// What stands for a figure that a run does not have.
pub(crate) const NONE: &str = "–";

/// A column: its heading, what it shows of a run, and whether it is there even if no run has it.
type Column = (&'static str, fn(&RunResult) -> Option<String>, bool);

/// The columns from left to right.
const COLUMNS: [Column; 22] = [
    ("scene", |result| Some(result.scenario.clone()), true),
    ("policy", |result| Some(result.policy.clone()), true),
    ("outcome", |result| Some(result.outcome.to_string()), true),
    ("error mm", |result| Some(mean_std(result.error_mm.mean?, result.error_mm.std)), true),
    ("p95", |result| result.error_mm.p95.map(millimetres), true),
    ("max", |result| result.error_mm.max.map(millimetres), true),
    ("outliers", |result| result.error_mm.outliers.map(|share| percent(share, 2)), true),
    ("in 95 %", |result| result.error_mm.within_band.map(|share| percent(share, 1)), true),
    ("coverage", |result| Some(percent(result.coverage, 1)), true),
    ("passage", |result| Some(percent(result.passage?.share, 1)), false),
    ("wall coverage", |result| Some(percent(result.passage?.wall_coverage, 1)), false),
    ("Hausdorff mm", |result| result.hausdorff_mm.map(millimetres), true),
    ("retrieval mm", |result| spread(result.retrieval?.radius_mm), false),
    ("axis mm", |result| spread(result.axis_mm?), false),
    ("corners", |result| result.corners.map(|corners| format!("{} of {}", corners.traced, corners.count)), false),
    ("corner mm", |result| result.corners?.place_mm.mean.map(millimetres), false),
    ("corner s", |result| result.corners?.time_s.mean.map(|time| format!("{time:.1}")), false),
    ("corner m", |result| result.corners?.path_m.mean.map(|path| format!("{path:.2}")), false),
    ("collisions", |result| (result.collisions.count > 0).then(|| result.collisions.count.to_string()), false),
    ("sim s", |result| Some(format!("{:.1}", result.sim_s)), true),
    ("× real time", |result| result.realtime.map(|realtime| format!("{realtime:.0}")), true),
    ("tick µs", |result| result.tick_us.mean.map(|mean| format!("{mean:.1}")), true),
];

/// A table of results, one line each: lengths in mm, times as their headings say. What not every run has, such as corners,
/// is there if one has it. Plain text, as wide as it needs to be.
#[must_use]
pub fn table(results: &[RunResult]) -> String {
    let shown = |&&(_, text, always): &&Column| always || results.iter().any(|result| text(result).is_some());
    let columns: Vec<_> = COLUMNS.iter().filter(shown).collect();
    let lines = results.iter().map(|result| {
        columns.iter().map(|(_, text, _)| text(result).unwrap_or_else(|| NONE.to_owned())).collect::<Vec<_>>()
    });
    ruled(columns.iter().map(|(heading, ..)| *heading), lines, 3)
}

/// A table with rules above, below and under its headings; all but the first `names` columns are figures, which stand to the
/// right.
pub(crate) fn ruled<'h>(
    headings: impl IntoIterator<Item = &'h str>,
    lines: impl IntoIterator<Item = Vec<String>>,
    names: usize,
) -> String {
    let mut table = Table::new();
    let rule = LineStyle::none().fill('─').junction('─');
    let style = TableStyle::new().top_border(rule).header_separator(rule).bottom_border(rule);
    table.load_style(style).set_header(headings);
    for line in lines {
        table.add_row(line.into_iter().map(Cell::new));
    }
    for column in table.column_iter_mut().skip(names) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}

/// A share (0 to 1) in percent.
pub(crate) fn percent(share: f64, digits: usize) -> String {
    format!("{:.digits$} %", 100.0 * share)
}

fn spread(figure: MeanStd) -> Option<String> {
    Some(mean_std(figure.mean?, figure.std))
}
