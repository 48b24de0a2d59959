//! How far a tier is from another.

use crate::report::Document;
use serde::Serialize;

use crate::report::{NONE, Table};
use crate::score::Statistics;
use crate::study::Ending;

/// How far a tier is from another, the reference, in one scene under one policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TierRow {
    /// The scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// The tier.
    pub tier: &'static str,
    /// What it is compared with.
    pub reference: &'static str,
    /// How the policy's run ended in the tier.
    pub outcome: Ending,
    /// Why, if not as it should.
    pub reason: Option<String>,
    /// How long both were carried along the reference's way.
    pub along_s: f64,
    /// Why no farther, if that is not all of it.
    pub stopped: Option<String>,
    /// How many ticks of whiskers are compared.
    pub compared: usize,
    /// Of those in which a whisker touches in either, the share that is not.
    pub left_out: f64,
    /// How far apart tips are.
    pub tip_mm: Option<Apart>,
    /// How far apart moments at the base are.
    pub moment_un_m: Option<Apart>,
    /// Their mean, over the mean of the reference's moments.
    pub moment_share: Option<f64>,
    /// Mean distance of the tips that the policy's run recorded from the contour of the reference's run.
    pub contour_mm: Option<f64>,
}

impl Document for TierRow {
    const FORMAT: &'static str = "worlds";
}

/// Differences, by their sizes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Apart {
    /// Their mean.
    pub mean: f64,
    /// Their 95th percentile.
    pub p95: f64,
    /// The greatest.
    pub max: f64,
}

impl Apart {
    /// Those of some differences; `None` if there are none.
    pub(super) fn of(differences: Vec<f64>) -> Option<Self> {
        let statistics = Statistics::of(differences)?;
        Some(Self { mean: statistics.mean(), p95: statistics.percentile(95.0), max: statistics.max() })
    }
}

const HEADINGS: [&str; 11] = [
    "scene",
    "policy",
    "tier",
    "its run",
    "tip mm",
    "contour mm",
    "moment µN m",
    "of the moment",
    "left out",
    "p95 tip mm",
    "p95 moment µN m",
];

/// A table with a line for every scene, policy and tier: how far tips and moments are from the reference's, mean and 95th percentile, what
/// share of the moment that is; how far contours are apart; what share of the ticks was left out, and how the policy's run ended.
#[must_use]
pub fn tiers_table(rows: &[TierRow]) -> Table {
    let shown = |value: Option<f64>, text: &dyn Fn(f64) -> String| value.map_or_else(|| NONE.to_owned(), text);
    let lines = rows.iter().map(|row| {
        let millimetres = |value: f64| format!("{value:.4}");
        let moment = |value: f64| format!("{value:.2}");
        vec![
            row.scenario.clone(),
            row.policy.clone(),
            row.tier.to_owned(),
            row.outcome.name().to_owned(),
            shown(row.tip_mm.map(|tip| tip.mean), &millimetres),
            shown(row.contour_mm, &millimetres),
            shown(row.moment_un_m.map(|apart| apart.mean), &moment),
            shown(row.moment_share, &|share| format!("{:.2} %", 100.0 * share)),
            format!("{:.1} %", 100.0 * row.left_out),
            shown(row.tip_mm.map(|tip| tip.p95), &millimetres),
            shown(row.moment_un_m.map(|apart| apart.p95), &moment),
        ]
    });
    Table::new(4, HEADINGS, lines)
}
