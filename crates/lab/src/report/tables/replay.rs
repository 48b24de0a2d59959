//! A replay as tables.

use super::super::table::Table;
use super::faults_table;
use crate::results::ReplayResult;

/// The tables of a replay: the comparison, the difference if there is one, and the faults if there are some.
#[must_use]
pub fn replay_tables(result: &ReplayResult) -> Vec<Table> {
    let machine = result.recording.get("machine").cloned().unwrap_or_default();
    let verdict = if result.difference.is_none() { "bit-identical" } else { "different" };
    let headings = ["machine", "steps", "compared", "end s", "results"];
    let row = [
        machine,
        result.steps.to_string(),
        result.ticks.to_string(),
        format!("{:.3}", result.end_s),
        verdict.to_owned(),
    ];
    let mut tables = vec![Table::new(1, headings, [row.to_vec()])];
    if let Some(difference) = &result.difference {
        let row = [
            difference.field.clone(),
            difference.step.to_string(),
            format!("{:.3}", difference.time_s),
            difference.recorded.clone(),
            difference.replayed.clone(),
        ];
        tables.push(Table::new(1, ["first difference", "step", "time s", "recorded", "replayed"], [row.to_vec()]));
    }
    if !result.faults.is_empty() {
        tables.push(faults_table(&result.faults));
    }
    tables
}
