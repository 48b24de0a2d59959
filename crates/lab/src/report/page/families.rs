//! Random scenes as a page.

use maud::{Markup, html};

use super::document::page;
use super::run::place;
use super::table::{Judgement, PageCell, PageTable};
use crate::family::{FamilyRun, FamilyTally};
use crate::report::table::NONE;
use crate::report::tables::families_table;
use crate::report::tables::results::text;
use crate::results::{LargestError, Provenance};
use vibrissa_declare::figures::{Cell, Metric};

/// Number of the runs with the largest errors that are named.
const WORST_NAMED: usize = 10;

/// A page with the pass rates of families, the runs that did not pass, and the largest errors. `pictures` has the address of the picture
/// of each run that has one. It needs no other file than these pictures.
#[must_use]
pub fn families_page(
    provenance: &Provenance,
    tallies: &[FamilyTally],
    runs: &[FamilyRun],
    pictures: &[Option<String>],
) -> String {
    let passed = runs.iter().filter(|run| run.passed).count();
    let picture = |index: usize| pictures.get(index).and_then(Option::as_deref);
    let introduction = html! {
        p.lead { (passed) " of " (runs.len()) " runs passed." }
        p {
            "A run passes if all expectations of its scene hold. Intervals of rates are those of Wilson at 95 %. "
            "Errors are means over the completed runs."
        }
    };
    let sections = html! {
        section { h2 { "Pass rates" } (PageTable::new("families", &families_table(tallies)).markup()) }
        (not_passed(runs, picture))
        (largest_errors(runs, picture))
        section { h2 { "Runs" } details { summary { (runs.len()) " runs" } (run_table(runs, picture).markup()) } }
    };
    page("Vibrissa families", provenance, &introduction, &sections)
}

fn label(run: &FamilyRun) -> String {
    format!("{}, trial {}", run.family, run.trial)
}

fn linked(text: &str, picture: Option<&str>) -> Markup {
    html! { @match picture { Some(address) => a href=(address) { (text) }, None => (text) } }
}

fn not_passed<'p>(runs: &[FamilyRun], picture: impl Fn(usize) -> Option<&'p str>) -> Markup {
    let failed: Vec<_> = runs.iter().enumerate().filter(|(_, run)| !run.passed).collect();
    html! {
        @if !failed.is_empty() {
            section {
                h2 { "Not passed" }
                ul.worst {
                    @for (index, run) in failed {
                        li { (linked(&label(run), picture(index))) " (" (run.about) "): " (run.result.violations.join("; ")) }
                    }
                }
            }
        }
    }
}

fn largest_errors<'p>(runs: &[FamilyRun], picture: impl Fn(usize) -> Option<&'p str>) -> Markup {
    let known =
        runs.iter().enumerate().filter_map(|(index, run)| Some((index, run, run.result.largest_error.as_ref()?)));
    let mut worst: Vec<(usize, &FamilyRun, &LargestError)> = known.collect();
    worst.sort_by(|a, b| b.2.error_mm.total_cmp(&a.2.error_mm));
    html! {
        @if !worst.is_empty() {
            section {
                h2 { "Largest errors" }
                ul.worst {
                    @for (index, run, error) in worst.into_iter().take(WORST_NAMED) {
                        li { (linked(&label(run), picture(index))) ": " (place(error)) }
                    }
                }
            }
        }
    }
}

fn run_table<'p>(runs: &[FamilyRun], picture: impl Fn(usize) -> Option<&'p str>) -> PageTable {
    let row = |(index, run): (usize, &FamilyRun)| {
        let result = &run.result;
        let worse = |is_worse: bool| is_worse.then_some(Judgement::Worse);
        let figure = |metric, digits| text(result, metric, Cell::Decimals(digits)).unwrap_or_else(|| NONE.to_owned());
        let passed = if run.passed { "yes" } else { "no" };
        let family = PageCell { link: picture(index).map(str::to_owned), ..PageCell::from(run.family.clone()) };
        let passed = PageCell { judgement: worse(!run.passed), ..PageCell::from(passed.to_owned()) };
        let texts = [
            figure(Metric::ErrorMean, 3),
            figure(Metric::ErrorMax, 3),
            figure(Metric::Coverage, 1),
            figure(Metric::Collisions, 0),
            run.result.violations.join("; "),
            run.about.clone(),
        ];
        [family, PageCell::from(run.trial.to_string()), PageCell::from(format!("{:.0}", 100.0 * run.speed)), passed]
            .into_iter()
            .chain(texts.map(PageCell::from))
            .collect()
    };
    let headings = [
        "family",
        "trial",
        "cm/s",
        "passed",
        "error mm",
        "largest error mm",
        "coverage",
        "collisions",
        "reason",
        "about",
    ];
    PageTable {
        title: "family-runs".to_owned(),
        headings: headings.map(str::to_owned).to_vec(),
        names: 4,
        rows: runs.iter().enumerate().map(row).collect(),
    }
}
