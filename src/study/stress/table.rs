//! Hard cases as tables.

use crate::report::{NONE, ruled};

use super::run::StressRow;

/// Two tables: how every case ended, and the largest stable step of every setting.
#[must_use]
pub fn stress_table(rows: &[StressRow]) -> String {
    let cases = rows.iter().filter_map(|row| match row {
        StressRow::Case { name, world, drive, outcome, reason, sim_s, finite } => Some(vec![
            name.clone(),
            world.clone(),
            drive.clone(),
            serde_json::to_value(outcome).ok()?.as_str()?.to_owned(),
            if *finite { String::new() } else { "not finite".to_owned() },
            format!("{sim_s:.2}"),
            shortened(reason.as_deref().unwrap_or("")),
        ]),
        StressRow::Step { .. } => None,
    });
    let steps = rows.iter().filter_map(|row| match row {
        StressRow::Step { name, world, largest_ms, .. } => {
            let largest = largest_ms.map_or_else(|| NONE.to_owned(), |step| format!("{step:.2}"));
            Some(vec![name.clone(), world.clone(), largest])
        }
        StressRow::Case { .. } => None,
    });
    let cases = ruled(["case", "world", "driven", "outcome", "numbers", "sim s", "reason"], cases, 7);
    let steps = ruled(["setting", "world", "largest stable step ms"], steps, 2);
    format!("{cases}\n\n{steps}")
}

/// The first letters of a text.
fn shortened(text: &str) -> String {
    const MOST: usize = 60;
    if text.chars().count() <= MOST { text.to_owned() } else { text.chars().take(MOST).collect::<String>() + "…" }
}
