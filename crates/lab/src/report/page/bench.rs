//! The bench as a page.

use maud::html;

use super::changes::changes_section;
use super::document::page;
use super::run::{PageRun, RunFigures, address, overview, section};
use super::table::{Judgement, PageCell, PageTable};
use crate::report::tables::bench::{COLUMNS, NAMES};
use crate::results::{Ending, Provenance};
use crate::study::bench::{BenchRow, Verdict};
use crate::study::compare::Changes;

/// The column of the outcome.
const OUTCOME: usize = 2;

/// A page with the table of the bench, the figures of every run, and the changes since an older report. It needs no other file.
#[must_use]
pub fn bench_page(
    provenance: &Provenance,
    rows: &[BenchRow],
    figures: &[RunFigures],
    changes: Option<&Changes>,
) -> String {
    let passed = rows.iter().filter(|row| row.passed).count();
    let runs = rows.iter().zip(figures).map(|(row, figures)| PageRun {
        scene: row.scene(),
        result: &row.result,
        figures,
        passed: row.passed,
    });
    let runs: Vec<_> = runs.collect();
    let introduction = html! {
        p.lead { (passed) " of " (rows.len()) " runs passed." }
        p {
            "A run completes if it meets its stop condition and all expectations of its scenario hold. If some do not hold, it has ended. A run passes if it completes and no figure is worse than the baseline's. Figures are mean ± sample \
             standard deviation. The baseline has neither friction nor noise. A run with friction, noise or a mismatch only has to complete."
        }
    };
    let sections = html! {
        (overview(&runs))
        @if let Some(changes) = changes { (changes_section(changes)) }
        section { h2 { "Figures" } (table(rows).markup()) }
        @for (index, run) in runs.iter().enumerate() { (section(index, run)) }
    };
    page("Vibrissa bench", provenance, &introduction, &sections)
}

fn table(rows: &[BenchRow]) -> PageTable {
    let row = |row: &BenchRow| {
        let failed = row.result.outcome != Ending::Completed;
        let cells = COLUMNS.iter().enumerate().map(|(column, (_, cell))| {
            let (text, verdict) = cell(row);
            let judgement = match verdict {
                Some(Verdict::Better) => Some(Judgement::Better),
                Some(Verdict::Worse) => Some(Judgement::Worse),
                None => (column == OUTCOME && failed).then_some(Judgement::Worse),
            };
            PageCell { text, judgement, link: None }
        });
        cells.collect()
    };
    let rows: Vec<Vec<PageCell>> = rows.iter().map(row).collect();
    let headings = COLUMNS.map(|(heading, _)| heading.to_owned()).to_vec();
    PageTable { title: "bench".to_owned(), headings, names: NAMES, rows }.linked(|index| Some(address(index)))
}
