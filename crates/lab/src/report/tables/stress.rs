//! Stress tests as tables.

use super::super::table::{Table, known};
use crate::study::stress::StressRow;

/// Two tables: the outcome of every case, and the largest stable step of every setting.
#[must_use]
pub fn stress_tables(rows: &[StressRow]) -> [Table; 2] {
    let cases = rows.iter().filter_map(|row| match row {
        StressRow::Case { name, world, drive, outcome, reason, sim_s, finite } => Some(vec![
            name.clone(),
            world.clone(),
            drive.clone(),
            serde_json::to_value(outcome).ok()?.as_str()?.to_owned(),
            if *finite { String::new() } else { "not finite".to_owned() },
            format!("{sim_s:.2}"),
            reason.clone().unwrap_or_default(),
        ]),
        StressRow::Step { .. } => None,
    });
    let steps = rows.iter().filter_map(|row| match row {
        StressRow::Step { name, world, largest_ms, .. } => {
            let largest = known(*largest_ms, |step| format!("{step:.2}"));
            Some(vec![name.clone(), world.clone(), largest])
        }
        StressRow::Case { .. } => None,
    });
    [
        Table::new(7, ["case", "simulator", "driven", "outcome", "numbers", "sim s", "reason"], cases),
        Table::new(2, ["setting", "simulator", "largest stable step ms"], steps),
    ]
}
