//! The runs of `vibrissa run` as a page.

use maud::html;

use super::document::page;
use super::run::{PageRun, RunFigures, address, overview, section};
use super::table::PageTable;
use crate::report::tables::results_table;
use crate::results::{Provenance, RunResult};

/// A page with the results and figures of runs. Each is with a flag that is true if all expectations of its scenario hold. It needs no other file.
#[must_use]
pub fn runs_page(provenance: &Provenance, runs: &[(&RunResult, &RunFigures, bool)]) -> String {
    let results: Vec<RunResult> = runs.iter().map(|(result, ..)| (*result).clone()).collect();
    let table = PageTable::new("runs", &results_table(&results)).linked(|index| Some(address(index)));
    let runs: Vec<_> = (runs.iter())
        .map(|&(result, figures, passed)| PageRun { scene: result.scenario.clone(), result, figures, passed })
        .collect();
    let passed = runs.iter().filter(|run| run.passed).count();
    let introduction =
        html! { p.lead { (passed) " of " (runs.len()) " runs completed with all expectations of their scenarios." } };
    let sections = html! {
        (overview(&runs))
        section { h2 { "Figures" } (table.markup()) }
        @for (index, run) in runs.iter().enumerate() { (section(index, run)) }
    };
    page("Vibrissa runs", provenance, &introduction, &sections)
}
