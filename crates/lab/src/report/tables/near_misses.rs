//! Near misses as a table.

use super::super::table::{Table, percent};
use crate::inspect::NearMiss;

/// A table of near misses, in their order.
#[must_use]
pub fn near_miss_table(misses: &[NearMiss]) -> Table {
    let row = |miss: &NearMiss| {
        let line = miss.file.as_ref().map_or(miss.line.to_string(), |file| format!("{file}:{}", miss.line));
        vec![
            miss.margin.text.clone(),
            format!("`{}`", miss.part),
            miss.state.clone().unwrap_or_else(|| "any state".to_owned()),
            miss.target.clone(),
            miss.scenario.clone(),
            format!("{:.2}", miss.time_s),
            percent(miss.share, 2),
            line,
            miss.policy.clone(),
        ]
    };
    let headings =
        ["missing", "part of the guard", "state", "target", "scenario", "time s", "of largest", "line", "policy"];
    Table::new(4, headings, misses.iter().map(row))
}
