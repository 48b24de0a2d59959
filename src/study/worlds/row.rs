//! How far a simulation is from another.

use crate::results::Document;
use serde::Serialize;

use crate::results::Ending;
use crate::score::Statistics;

/// How far a simulation is from another, the reference, in one scene under one policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct WorldsRow {
    /// The scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// The simulation.
    pub simulation: &'static str,
    /// What it is compared with.
    pub reference: &'static str,
    /// How the policy's run ended in the simulation.
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

impl Document for WorldsRow {
    const FORMAT: &'static str = "worlds";
    // Version 1 had the key `tier`.
    const VERSION: u32 = 2;
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
