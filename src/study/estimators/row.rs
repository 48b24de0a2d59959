//! How one tip model did.

use crate::results::Document;
use serde::Serialize;

/// How one tip model did on the samples of one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EstimatorRow {
    /// The scene.
    pub scenario: String,
    /// The noise of the sensors, over the estimate of that of the real one.
    pub noise: f64,
    /// The tip model's name.
    pub model: &'static str,
    /// Of the points that the run had recorded by sliding and without noise, the share that it tells.
    pub told: f64,
    /// Mean distance of what it tells from the exact surface (mm), its 95th percentile, and the share of it within its own band.
    pub mean_mm: Option<f64>,
    /// See `mean_mm`.
    pub p95_mm: Option<f64>,
    /// See `mean_mm`.
    pub within_band: Option<f64>,
    /// The share of it that are outliers.
    pub outliers: Option<f64>,
    /// Number of points that it tells.
    pub tips: usize,
    /// The share of the points that it tells to be touches of the shaft.
    pub on_shaft: f64,
    /// Mean time that perception takes a tick (µs), all whiskers together.
    pub tick_us: f64,
}

impl Document for EstimatorRow {
    const FORMAT: &'static str = "estimators";
}
