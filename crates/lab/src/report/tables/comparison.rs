//! A comparison as tables.

use std::borrow::Cow;

use super::super::number::{RATES, rate, signed, significant};
use super::super::table::{NONE, Table};
use crate::study::compare::{Comparison, Difference, FigureComparison, Incomplete, Outlook};

/// The headings of the figures. The interval of a difference is never left out for lack of space.
const HEADINGS: [&str; 8] = ["figure", "difference", "95 % interval", "verdict", "mean", "first", "wins", "pairs"];

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
    let runs = comparison.policies.iter().map(|policy| {
        vec![policy.policy.clone(), policy.runs.to_string(), rate(policy.completed), rate(policy.collision_free)]
    });
    Table::new(1, ["policy", "runs", "completed %", "collision-free %"], runs).under(RATES)
}

/// The figures of a policy with their differences from the first one.
pub(in crate::report) fn figures_table(comparison: &Comparison, policy: &str) -> Table {
    let figures = comparison.figures.iter().filter(|figure| figure.policy == policy).map(|figure| {
        let figure = &*in_percent(figure);
        vec![
            figure.figure.to_owned(),
            signed(figure.difference.mean),
            interval(figure),
            match figure.outlook {
                Outlook::Better => "better",
                Outlook::Worse => "worse",
                Outlook::Same => "the same",
                Outlook::Open => "not distinguishable",
            }
            .to_owned(),
            significant(figure.mean),
            significant(figure.first),
            format!("{} of {}", figure.wins, figure.wins + figure.losses),
            figure.pairs.to_string(),
        ]
    });
    let first = comparison.policies.first().map_or(NONE, |first| &first.policy);
    Table::new(1, HEADINGS, figures).under(format!(
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
    interval.map_or_else(|| NONE.to_owned(), |[low, high]| format!("{} .. {}", signed(low), signed(high)))
}
