//! A comparison as tables.

use super::super::number::{RATES, rate};
use super::super::table::{NONE, Table};
use crate::study::compare::{Comparison, Outlook};

const HEADINGS: [&str; 9] =
    ["figure", "policy", "verdict", "mean", "first", "difference", "95 % interval", "wins", "pairs"];

/// A comparison as two tables: the rates of runs that completed and that were collision-free, and the figures with their differences from
/// the first policy.
#[must_use]
pub fn comparison_tables(comparison: &Comparison) -> [Table; 2] {
    let runs = comparison.policies.iter().map(|policy| {
        vec![policy.policy.clone(), policy.runs.to_string(), rate(policy.completed), rate(policy.collision_free)]
    });
    let figures = comparison.figures.iter().map(|figure| {
        let interval = figure
            .difference
            .interval
            .map_or_else(|| NONE.to_owned(), |[low, high]| format!("{} .. {}", signed(low), signed(high)));
        vec![
            figure.figure.to_owned(),
            figure.policy.clone(),
            match figure.outlook {
                Outlook::Better => "better",
                Outlook::Worse => "worse",
                Outlook::Same => "the same",
                Outlook::Open => "not distinguishable",
            }
            .to_owned(),
            number(figure.mean),
            number(figure.first),
            signed(figure.difference.mean),
            interval,
            format!("{} of {}", figure.wins, figure.wins + figure.losses),
            figure.pairs.to_string(),
        ]
    });
    let first = comparison.policies.first().map_or(NONE, |first| &first.policy);
    [
        Table::new(1, ["policy", "runs", "completed %", "collision-free %"], runs).under(RATES),
        Table::new(3, HEADINGS, figures).under(format!(
            "Against {first}: `completed` over all runs, the rest over the runs in which both met the stop condition"
        )),
    ]
}

/// A number with a useful number of decimals.
fn number(value: f64) -> String {
    format!("{value:.*}", decimals(value))
}

fn signed(value: f64) -> String {
    format!("{value:+.*}", decimals(value))
}

fn decimals(value: f64) -> usize {
    match value.abs() {
        size if size < 0.1 => 4,
        size if size < 1.0 => 3,
        size if size < 100.0 => 2,
        _ => 0,
    }
}
