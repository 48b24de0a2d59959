//! Families as a table.

use super::super::number::RATES;
use super::super::table::Table;
use super::tally;
use crate::family::FamilyTally;

/// A table with a row for every tally. Errors are means over the completed runs. Outliers and intervals are shares of
/// the tips of all runs.
#[must_use]
pub fn families_table(tallies: &[FamilyTally]) -> Table {
    let headings = ["family", "cm/s"].into_iter().chain(tally::COLUMNS.map(|(heading, _)| heading));
    Table::new(2, headings, tallies.iter().map(cells)).under(RATES)
}

fn cells(FamilyTally { family, speed, tally }: &FamilyTally) -> Vec<String> {
    let speed = speed.map_or_else(|| "all".to_owned(), |speed| format!("{:.0}", 100.0 * speed));
    [(*family).clone(), speed].into_iter().chain(tally::COLUMNS.map(|(_, text)| text(tally))).collect()
}
