//! Near misses as a table.

use super::super::table::{Table, percent};
use crate::inspect::NearMiss;

/// A table of near misses, in their order. A policy that all of them share is named above it.
#[must_use]
pub fn near_miss_table(misses: &[NearMiss]) -> Table {
    let shared = misses.first().map(|first| &first.policy).filter(|of| misses.iter().all(|miss| miss.policy == **of));
    let row = |miss: &NearMiss| {
        let line = miss.file.as_ref().map_or(miss.line.to_string(), |file| format!("{file}:{}", miss.line));
        let mut row = vec![
            miss.margin.text.clone(),
            format!("`{}`", miss.part),
            miss.state.clone().unwrap_or_else(|| "any state".to_owned()),
            miss.target.clone(),
            miss.scenario.clone(),
            format!("{:.2}", miss.time_s),
            percent(miss.share, 2),
            line,
        ];
        if shared.is_none() {
            row.insert(0, miss.policy.clone());
        }
        row
    };
    let headings =
        ["policy", "missing", "part of the guard", "state", "target", "scenario", "time s", "of largest", "line"];
    let rows = misses.iter().map(row);
    match shared {
        Some(policy) => Table::new(4, headings.into_iter().skip(1), rows).under(format!("Policy: {policy}")),
        None => Table::new(5, headings, rows),
    }
}
