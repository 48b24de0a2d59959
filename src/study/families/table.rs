//! Families as a table.

use crate::report::{NONE, millimetres, ruled};

use super::tally::FamilyTally;

const HEADINGS: [&str; 11] = [
    "family",
    "cm/s",
    "runs",
    "completed",
    "and clean",
    "timeout",
    "failed",
    "diverged",
    "collided",
    "error mm",
    "p95",
];

/// A table, one line a tally. Errors are means over the runs that completed; clean are those without a contact of the body.
#[must_use]
pub fn families_table(tallies: &[FamilyTally]) -> String {
    ruled(HEADINGS, tallies.iter().map(cells), 1)
}

fn cells(tally: &FamilyTally) -> Vec<String> {
    let share = |count: usize| format!("{:.1} %", 100.0 * count as f64 / tally.runs as f64);
    let figure = |figure: Option<f64>| figure.map_or_else(|| NONE.to_owned(), millimetres);
    let count = |count: usize| count.to_string();
    vec![
        tally.family.to_owned(),
        tally.speed.map_or_else(|| "all".to_owned(), |speed| format!("{:.0}", 100.0 * speed)),
        count(tally.runs),
        share(tally.completed),
        share(tally.clean),
        count(tally.timeout),
        count(tally.failed),
        count(tally.diverged),
        count(tally.collided),
        figure(tally.error_mean_mm),
        figure(tally.error_p95_mm),
    ]
}
