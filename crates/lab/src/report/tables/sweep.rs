//! The summary of a sweep as a table.

use super::super::number::RATES;
use super::super::table::Table;
use super::tally;
use crate::results::Tally;
use crate::sweep::SweepGroup;

/// A heading with its count.
type CountColumn = (&'static str, fn(&Tally) -> usize);

/// A table with a row for every group. Crashed and refused runs have columns if there are any.
#[must_use]
pub fn summary_table(groups: &[SweepGroup]) -> Table {
    let settings: Vec<&str> =
        groups.first().into_iter().flat_map(|group| group.settings.keys().map(String::as_str)).collect();
    let crashed: CountColumn = ("crashed", |tally| tally.crashed);
    let refused: CountColumn = ("refused", |tally| tally.refused);
    let columns = [crashed, refused].into_iter();
    let columns: Vec<CountColumn> =
        columns.filter(|(_, count)| groups.iter().any(|group| count(&group.tally) > 0)).collect();
    let headings = std::iter::once("scenes").chain(settings.iter().copied()).chain(["policy"]);
    let headings =
        headings.chain(tally::COLUMNS.map(|(heading, _)| heading)).chain(columns.iter().map(|(heading, _)| *heading));
    let cells = |SweepGroup { scenes, settings, policy, tally }: &SweepGroup| {
        let names = std::iter::once(scenes.clone()).chain(settings.values().cloned()).chain([policy.clone()]);
        names
            .chain(tally::COLUMNS.map(|(_, text)| text(tally)))
            .chain(columns.iter().map(|(_, count)| count(tally).to_string()))
            .collect()
    };
    Table::new(2 + settings.len(), headings, groups.iter().map(cells)).under(RATES)
}
