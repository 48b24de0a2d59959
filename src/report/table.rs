//! Results as a table for the terminal.

use comfy_table::{Cell, CellAlignment, LineStyle, Table, TableStyle};

use super::RunResult;
use super::number::{mean_std, millimetres};

/// What stands for a figure that a run does not have.
const NONE: &str = "–";

/// A table of results, one line each: lengths in mm, times as their headings say. Plain text, as wide as it needs to be.
#[must_use]
pub fn table(results: &[RunResult]) -> String {
    let headings = [
        "scene",
        "policy",
        "outcome",
        "error mm",
        "p95",
        "max",
        "coverage",
        "Hausdorff mm",
        "sim s",
        "× real time",
        "tick µs",
    ];
    let mut table = Table::new();
    let rule = LineStyle::none().fill('─').junction('─');
    let style = TableStyle::new().top_border(rule).header_separator(rule).bottom_border(rule);
    table.load_style(style).set_header(headings);
    for result in results {
        table.add_row(line(result).map(Cell::new));
    }
    for column in table.column_iter_mut().skip(3) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}

fn line(result: &RunResult) -> [String; 11] {
    let error = &result.error_mm;
    let or_none = |figure: Option<String>| figure.unwrap_or_else(|| NONE.to_owned());
    [
        result.scenario.clone(),
        result.policy.clone(),
        result.outcome.to_string(),
        or_none(error.mean.map(|mean| mean_std(mean, error.std))),
        or_none(error.p95.map(millimetres)),
        or_none(error.max.map(millimetres)),
        format!("{:.1} %", 100.0 * result.coverage),
        or_none(result.hausdorff_mm.map(millimetres)),
        format!("{:.1}", result.sim_s),
        or_none(result.realtime.map(|realtime| format!("{realtime:.0}"))),
        or_none(result.tick_us.mean.map(|mean| format!("{mean:.1}"))),
    ]
}
