//! A comparison of policies as a page.

use maud::html;

use super::changes::sentences;
use super::document::page;
use super::table::{Judgement, PageTable};
use crate::report::tables::comparison::{figures_table, incomplete_table, runs_table};
use crate::results::Provenance;
use crate::study::compare::{Comparison, FigureComparison, Outlook};

/// The column of the verdict.
const VERDICT: usize = 3;

/// A page with the tables of a comparison, and its differences in words. It needs no other file.
#[must_use]
pub fn comparison_page(provenance: &Provenance, comparison: &Comparison) -> String {
    let first = comparison.policies.first().map_or("", |first| first.policy.as_str());
    let introduction = html! {
        p.lead { "Compared with " (first) ", over pairs of runs with the same scene, start and noise." }
        p {
            "Each difference is that of the policy minus that of " (first) ", as the mean over all pairs, with its 95 % interval: \
             by Student's t, and for the share of completed runs the exact one over the pairs that differ. A figure is better or worse if the interval does not contain zero."
        }
    };
    let sections = html! {
        section { h2 { "Runs" } (PageTable::new("runs", &runs_table(comparison)).markup()) }
        @if let Some(incomplete) = incomplete_table(comparison) {
            section {
                h2 { "Runs that did not complete" }
                p { "If such a run did not meet its stop condition, only " code { "completed %" } " counts of its figures." }
                (PageTable::new("incomplete", &incomplete).markup())
            }
        }
        @for other in comparison.policies.iter().skip(1) {
            section {
                h2 { (other.policy) }
                (sentences(of(comparison, &other.policy)))
                p { "The figure " code { "completed %" } " is over all runs, and every other one is over the runs in which both policies met the stop condition." }
                (figures(comparison, &other.policy).markup())
            }
        }
    };
    page("Vibrissa comparison", provenance, &introduction, &sections)
}

/// The figures of a policy.
fn of<'c>(comparison: &'c Comparison, policy: &str) -> impl Iterator<Item = &'c FigureComparison> {
    comparison.figures.iter().filter(move |figure| figure.policy == policy)
}

/// The table of a policy with coloured verdicts.
fn figures(comparison: &Comparison, policy: &str) -> PageTable {
    let mut table = PageTable::new(format!("comparison-{policy}"), &figures_table(comparison, policy));
    for (row, figure) in table.rows.iter_mut().zip(of(comparison, policy)) {
        if let Some(cell) = row.get_mut(VERDICT) {
            cell.judgement = match figure.outlook {
                Outlook::Better => Some(Judgement::Better),
                Outlook::Worse => Some(Judgement::Worse),
                Outlook::Same | Outlook::Open => None,
            };
        }
    }
    table
}
