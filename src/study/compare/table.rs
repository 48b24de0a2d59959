//! A comparison as tables.

use std::fmt::Write;

use crate::report::{NONE, ruled};

use super::comparison::Comparison;
use super::difference::Outlook;

const HEADINGS: [&str; 8] = ["figure", "policy", "pairs", "first", "mean", "difference, 95 %", "wins", "which is"];

/// A comparison for the terminal: how many runs did not complete, and the figures with their differences from the first policy.
#[must_use]
pub fn comparison_table(comparison: &Comparison) -> String {
    let runs = comparison
        .policies
        .iter()
        .map(|policy| vec![policy.policy.clone(), policy.runs.to_string(), policy.incomplete.len().to_string()]);
    let mut text = ruled(["policy", "runs", "not completed"], runs, 1);
    if let Some(first) = comparison.policies.first() {
        let _ = write!(
            text,
            "\n\nAgainst {}, `completed` over all runs, the rest over those that both completed:\n",
            first.policy
        );
    }
    let figures = comparison.figures.iter().map(|figure| {
        let interval = figure
            .difference
            .interval
            .map_or_else(|| NONE.to_owned(), |[low, high]| format!("{} .. {}", signed(low), signed(high)));
        vec![
            figure.figure.to_owned(),
            figure.policy.clone(),
            figure.pairs.to_string(),
            number(figure.first),
            number(figure.mean),
            format!("{} ({interval})", signed(figure.difference.mean)),
            format!("{} of {}", figure.wins, figure.wins + figure.losses),
            match figure.outlook {
                Outlook::Better => "better",
                Outlook::Worse => "worse",
                Outlook::Same => "the same",
                Outlook::Open => "not distinguishable",
            }
            .to_owned(),
        ]
    });
    text + &ruled(HEADINGS, figures, 2)
}

/// A number with as many decimals as are worth reading.
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
