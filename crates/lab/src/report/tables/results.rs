//! Results of runs as a table.

use super::super::number::{mean_std, millimetres};
use super::super::table::{NONE, Table, percent};
use crate::results::RunResult;
use vibrissa_declare::figures::{self as declared, Cell, Kind, Metric};

/// A column: its place among the columns, its heading, its text for a run, and whether it is shown even if no run has the figure.
type Column = (u16, &'static str, Box<dyn Fn(&RunResult) -> Option<String>>, bool);

/// A column that has no figure.
fn other(rank: u16, heading: &'static str, text: fn(&RunResult) -> Option<String>, is_always: bool) -> Column {
    (rank, heading, Box::new(text), is_always)
}

/// The columns from left to right.
fn columns() -> Vec<Column> {
    let mut columns = vec![
        other(0, "scene", |result| Some(result.scenario.clone()), true),
        other(10, "policy", |result| Some(result.policy_label()), true),
        other(20, "outcome", |result| Some(result.outcome.to_string()), true),
        other(90, "coverage of outlines", |result| outlines(&result.outline_coverages), false),
        other(110, "seem dead", dead_whiskers, false),
        other(150, "× real time", |result| result.realtime.map(|realtime| format!("{realtime:.0}")), true),
        other(200, "corners", corners, false),
        other(270, "simulator", |result| Some(result.world.clone()), true),
    ];
    columns.extend(Metric::ALL.into_iter().filter_map(|metric| {
        let declared::Column { rank, heading, cell, is_always } = metric.figure().column?;
        Some((rank, heading, Box::new(move |result: &RunResult| text(result, metric, cell)) as Box<_>, is_always))
    }));
    columns.sort_by_key(|(rank, ..)| *rank);
    columns
}

/// A figure in a cell. `None` if the run does not have it.
pub(in crate::report) fn text(result: &RunResult, metric: Metric, cell: Cell) -> Option<String> {
    let value = result.figure(metric)?;
    match (cell, metric.figure().kind) {
        (Cell::Spread, _) => Some(mean_std(value, metric.beside("std").and_then(|std| result.figure(std)))),
        (Cell::Positive(_), _) if value <= 0.0 => None,
        (Cell::Decimals(digits) | Cell::Positive(digits), Kind::Share) => Some(percent(value, digits)),
        (_, Kind::Length) if metric.figure().unit() == "mm" => Some(millimetres(value)),
        (Cell::Decimals(digits) | Cell::Positive(digits), _) => Some(format!("{value:.digits$}")),
    }
}

/// A table of results with a row for each. A figure that some runs lack, such as corners, has a column if one run has
/// it.
#[must_use]
pub fn results_table(results: &[RunResult]) -> Table {
    let mut columns = columns();
    columns.retain(|(_, _, text, is_always)| *is_always || results.iter().any(|result| text(result).is_some()));
    let cell = |text: Option<String>| text.unwrap_or_else(|| NONE.to_owned());
    let rows = results.iter().map(|result| columns.iter().map(|(_, _, text, _)| cell(text(result))).collect());
    Table::new(3, columns.iter().map(|(_, heading, ..)| *heading), rows)
}

/// The numbers of traced and of all sharp corners.
pub(super) fn corners(result: &RunResult) -> Option<String> {
    Some(format!("{} of {}", result.figure(Metric::CornersTraced)?, result.figure(Metric::Corners)?))
}

/// The coverage of each outline, if there are several.
fn outlines(coverages: &[f64]) -> Option<String> {
    (coverages.len() > 1).then(|| coverages.iter().map(|&coverage| percent(coverage, 1)).collect::<Vec<_>>().join(", "))
}

/// The whiskers that seem dead or insensitive, if there are any.
pub(super) fn dead_whiskers(result: &RunResult) -> Option<String> {
    let names: Vec<_> = result.dead_whiskers().map(|whisker| whisker.whisker.as_str()).collect();
    (!names.is_empty()).then(|| names.join(", "))
}
