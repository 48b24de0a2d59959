//! A comparison as tables.

use std::borrow::Cow;

use super::super::number::{RATES, rate, signed, significant};
use super::super::table::{Column, NONE, Table, known};
use crate::study::compare::{Comparison, Difference, FigureComparison, Incomplete, Outlook, PolicyRuns};

/// A comparison as tables: the rates of runs that completed and that were collision-free, and for each other policy its figures with their
/// differences from the first policy.
#[must_use]
pub fn comparison_tables(comparison: &Comparison) -> Vec<Table> {
    let others = comparison.policies.iter().skip(1);
    std::iter::once(runs_table(comparison))
        .chain(others.map(|other| figures_table(comparison, &other.policy)))
        .collect()
}

/// The rates of runs of each policy that completed and that were collision-free.
pub(in crate::report) fn runs_table(comparison: &Comparison) -> Table {
    let columns: [Column<'_, PolicyRuns>; 4] = [
        ("policy", &|runs| runs.policy.clone()),
        ("runs", &|runs| runs.runs.to_string()),
        ("completed %", &|runs| rate(runs.completed)),
        ("collision-free %", &|runs| rate(runs.collision_free)),
    ];
    Table::of(1, &comparison.policies, &columns).under(RATES)
}

/// The figures of a policy with their differences from the first one. The interval of a difference is never left out for lack of
/// space.
pub(in crate::report) fn figures_table(comparison: &Comparison, policy: &str) -> Table {
    let figures = comparison.figures.iter().filter(|figure| figure.policy == policy).map(in_percent);
    let outlook = |figure: &FigureComparison| match figure.outlook {
        Outlook::Better => "better",
        Outlook::Worse => "worse",
        Outlook::Same => "the same",
        Outlook::Open => "not distinguishable",
    };
    let columns: [Column<'_, FigureComparison>; 8] = [
        ("figure", &|figure| figure.figure.to_owned()),
        ("difference", &|figure| signed(figure.difference.mean)),
        ("95 % interval", &interval),
        ("verdict", &|figure| outlook(figure).to_owned()),
        ("mean", &|figure| significant(figure.mean)),
        ("first", &|figure| significant(figure.first)),
        ("wins", &|figure| format!("{} of {}", figure.wins, figure.wins + figure.losses)),
        ("pairs", &|figure| figure.pairs.to_string()),
    ];
    let first = comparison.policies.first().map_or(NONE, |first| &first.policy);
    Table::of(1, figures.collect::<Vec<_>>().iter().map(AsRef::as_ref), &columns).under(format!(
        "{policy} minus {first}: `completed %` over all runs, the rest over the runs in which both met the stop condition"
    ))
}

/// The runs of all policies that did not complete. `None` if all did.
pub(in crate::report) fn incomplete_table(comparison: &Comparison) -> Option<Table> {
    let rows: Vec<_> = comparison
        .policies
        .iter()
        .flat_map(|runs| runs.incomplete.iter().map(|run| incomplete_row(&runs.policy, run)))
        .collect();
    (!rows.is_empty()).then(|| Table::new(3, ["policy", "scene", "seed", "outcome", "reason"], rows))
}

fn incomplete_row(policy: &str, Incomplete { scenario, seed, outcome, reason }: &Incomplete) -> Vec<String> {
    let reason = reason.clone().unwrap_or_else(|| NONE.to_owned());
    vec![policy.to_owned(), scenario.clone(), seed.to_string(), outcome.to_string(), reason]
}

/// The figure as it is shown. The share of runs that completed is in %, as in the table of the runs.
pub(in crate::report) fn in_percent(figure: &FigureComparison) -> Cow<'_, FigureComparison> {
    if figure.figure != "completed" {
        return Cow::Borrowed(figure);
    }
    let interval = figure.difference.interval.map(|ends| ends.map(|end| 100.0 * end));
    Cow::Owned(FigureComparison {
        figure: "completed %",
        first: 100.0 * figure.first,
        mean: 100.0 * figure.mean,
        difference: Difference { mean: 100.0 * figure.difference.mean, interval },
        ..figure.clone()
    })
}

fn interval(figure: &FigureComparison) -> String {
    let interval = figure.difference.interval;
    known(interval, |[low, high]| format!("{} .. {}", signed(low), signed(high)))
}
