//! Differences between a simulation and the reference.

use crate::results::Document;
use serde::Serialize;

use crate::results::Ending;
use crate::score::Statistics;

/// Differences between a simulation and the reference, in one scene under one policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorldsRow {
    /// The scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// The simulation.
    pub simulation: &'static str,
    /// The simulation that it is compared with.
    pub reference: &'static str,
    /// Outcome of the policy's run in the simulation.
    pub outcome: Ending,
    /// Reason of the outcome. `None` for a completed run.
    pub reason: Option<String>,
    /// Time for which both were moved along the reference's path.
    pub along_s: f64,
    /// Reason for a shorter time than that of the whole path.
    pub stopped: Option<String>,
    /// Number of ticks of whiskers that are compared.
    pub compared: usize,
    /// Share of ticks that are not compared, among those in which a whisker touches in either simulation.
    pub left_out: f64,
    /// Distances of the tips.
    pub tip_mm: Option<Differences>,
    /// Differences of the base moments.
    pub moment_un_m: Option<Differences>,
    /// Mean difference of the base moments over the mean of the reference's moments.
    pub moment_share: Option<f64>,
    /// Mean distance of the tips that the policy's run recorded from the contour of the reference's run.
    pub contour_mm: Option<f64>,
}

impl Document for WorldsRow {
    const FORMAT: &'static str = "worlds";
    // Version 1 had the key `tier`.
    // In version 2, a run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 3;
}

/// The sizes of differences.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Differences {
    /// Their mean.
    pub mean: f64,
    /// Their 95th percentile.
    pub p95: f64,
    /// The greatest.
    pub max: f64,
}

impl Differences {
    /// The statistics of some differences. `None` without any.
    pub(super) fn of(differences: Vec<f64>) -> Option<Self> {
        let statistics = Statistics::of(differences)?;
        Some(Self { mean: statistics.mean(), p95: statistics.percentile(95.0), max: statistics.max() })
    }
}
