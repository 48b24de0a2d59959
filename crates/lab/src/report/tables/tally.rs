//! The columns of a tally, which several tables share.

use super::super::number::{millimetres, rate, significant};
use super::super::table::{Column, known, percent};
use crate::results::Tally;

/// The columns.
pub(super) const COLUMNS: [Column<'_, Tally>; 14] = [
    ("runs", &|tally| tally.runs.to_string()),
    ("passed %", &|tally| rate(tally.rates.map(|rates| rates.passed))),
    ("completed %", &|tally| rate(tally.rates.map(|rates| rates.completed))),
    ("collision-free %", &|tally| rate(tally.rates.map(|rates| rates.collision_free))),
    ("passed but for tips %", &|tally| rate(tally.rates.map(|rates| rates.passed_but_for_tips))),
    ("error mm", &|tally| known(tally.error_mean_mm, millimetres)),
    ("its 95 % interval", &|tally| {
        known(tally.error_mean_interval_mm, |[low, high]| format!("{} .. {}", significant(low), significant(high)))
    }),
    ("outliers", &|tally| known(tally.outliers, |share| percent(share, 2))),
    ("in 95 % interval", &|tally| known(tally.within_band, |share| percent(share, 1))),
    ("collided", &|tally| tally.collided.to_string()),
    ("timeout", &|tally| tally.timeout.to_string()),
    ("failed", &|tally| tally.failed.to_string()),
    ("diverged", &|tally| tally.diverged.to_string()),
    ("p95 error mm", &|tally| known(tally.error_p95_mm, millimetres)),
];
