//! A comparison of policies as a page.

use maud::html;

use super::changes::sentences;
use super::document::page;
use super::table::{Judgement, PageTable};
use crate::report::tables::comparison_tables;
use crate::study::compare::{Comparison, Outlook};

/// The column of the verdict.
const VERDICT: usize = 2;

/// A page with the tables of a comparison, and its differences in words. It needs no other file.
#[must_use]
pub fn comparison_page(comparison: &Comparison) -> String {
    let [runs, figures] = comparison_tables(comparison);
    let first = comparison.policies.first().map_or("", |first| first.policy.as_str());
    let mut figures = PageTable::new("comparison", &figures);
    for (row, figure) in figures.rows.iter_mut().zip(&comparison.figures) {
        if let Some(cell) = row.get_mut(VERDICT) {
            cell.judgement = match figure.outlook {
                Outlook::Better => Some(Judgement::Better),
                Outlook::Worse => Some(Judgement::Worse),
                Outlook::Same | Outlook::Open => None,
            };
        }
    }
    let introduction = html! {
        p.lead { "Compared with " (first) ", over pairs of runs with the same scene, start and noise." }
    };
    let sections = html! {
        @for other in comparison.policies.iter().skip(1) {
            section {
                h2 { (other.policy) }
                (sentences(comparison.figures.iter().filter(|figure| figure.policy == other.policy)))
            }
        }
        section {
            h2 { "Figures" }
            p { "The figure " code { "completed" } " is over all runs, and every other one is over the runs in which both policies met the stop condition." }
            (figures.markup())
        }
        section { h2 { "Runs" } (PageTable::new("runs", &runs).markup()) }
    };
    page("Vibrissa comparison", &introduction, &sections)
}
