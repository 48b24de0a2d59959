//! The cells of a tally, which several tables share.

use super::super::number::{millimetres, rate, significant};
use super::super::table::{NONE, percent};
use crate::results::Tally;

/// The headings of the cells.
pub(super) const HEADINGS: [&str; 14] = [
    "runs",
    "passed %",
    "completed %",
    "collision-free %",
    "passed but for tips %",
    "error mm",
    "its 95 % interval",
    "outliers",
    "in 95 % interval",
    "collided",
    "timeout",
    "failed",
    "diverged",
    "p95 error mm",
];

/// The cells under the headings.
pub(super) fn cells(tally: &Tally) -> [String; 14] {
    let share_of = |share: Option<f64>, digits| share.map_or_else(|| NONE.to_owned(), |share| percent(share, digits));
    let interval = tally
        .error_mean_interval_mm
        .map_or_else(|| NONE.to_owned(), |[low, high]| format!("{} .. {}", significant(low), significant(high)));
    let figure = |figure: Option<f64>| figure.map_or_else(|| NONE.to_owned(), millimetres);
    let rates = tally.rates.as_ref();
    [
        tally.runs.to_string(),
        rate(rates.map(|rates| rates.passed)),
        rate(rates.map(|rates| rates.completed)),
        rate(rates.map(|rates| rates.collision_free)),
        rate(rates.map(|rates| rates.passed_but_for_tips)),
        figure(tally.error_mean_mm),
        interval,
        share_of(tally.outliers, 2),
        share_of(tally.within_band, 1),
        tally.collided.to_string(),
        tally.timeout.to_string(),
        tally.failed.to_string(),
        tally.diverged.to_string(),
        figure(tally.error_p95_mm),
    ]
}
