//! The cells of a tally, which several tables share.

use super::super::number::millimetres;
use super::super::table::{NONE, percent};
use crate::results::Tally;

/// The headings of the cells.
pub(super) const HEADINGS: [&str; 11] = [
    "runs",
    "passed",
    "completed",
    "collided",
    "error mm",
    "outliers",
    "in 95 % interval",
    "timeout",
    "failed",
    "diverged",
    "p95 error mm",
];

/// The cells under the headings.
pub(super) fn cells(tally: &Tally) -> [String; 11] {
    let share = |count: usize| percent(count as f64 / tally.runs as f64, 1);
    let share_of = |share: Option<f64>, digits| share.map_or_else(|| NONE.to_owned(), |share| percent(share, digits));
    let figure = |figure: Option<f64>| figure.map_or_else(|| NONE.to_owned(), millimetres);
    [
        tally.runs.to_string(),
        share(tally.passed),
        share(tally.completed),
        tally.collided.to_string(),
        figure(tally.error_mean_mm),
        share_of(tally.outliers, 2),
        share_of(tally.within_band, 1),
        tally.timeout.to_string(),
        tally.failed.to_string(),
        tally.diverged.to_string(),
        figure(tally.error_p95_mm),
    ]
}
