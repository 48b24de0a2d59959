//! Run time against error as a page.

use maud::html;

use super::document::page;
use super::figure::figure;
use super::table::PageTable;
use crate::report::picture::pareto_picture;
use crate::report::tables::pareto_table;
use crate::results::Provenance;
use crate::study::pareto::Pareto;

/// A page with the table and the picture of every policy. It needs no other file.
#[must_use]
pub fn pareto_page(provenance: &Provenance, measured: &[Pareto]) -> String {
    let introduction = html! {
        p { "Each setting of the simulation has a run time relative to the default, and errors. A setting is Pareto-optimal if no faster one has a smaller error." }
    };
    let sections = html! {
        @for (index, pareto) in measured.iter().enumerate() {
            section {
                h2 { (pareto.scenario) ", " (pareto.policy) }
                (figure(&format!("{}-{}-pareto", pareto.scenario, pareto.policy), &format!("p{index}-"), &pareto_picture(pareto), &html! {
                    "Run time against error. Lines connect the Pareto-optimal settings."
                }, None))
                (PageTable::new(format!("{}-{}", pareto.scenario, pareto.policy), &pareto_table(pareto)).markup())
            }
        }
    };
    page("Vibrissa run time and error", provenance, &introduction, &sections)
}
