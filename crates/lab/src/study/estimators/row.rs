//! The figures of one contact estimator.

use crate::results::{CalibrationIdentity, Document};
use serde::Serialize;

/// The figures of one contact estimator on the samples of one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EstimatorRow {
    /// The scene.
    pub scenario: String,
    /// The calibration of the array, if the caller has one. `None` for an array that is the assumed one.
    pub calibration: Option<CalibrationIdentity>,
    /// Factor of the estimated noise of the real sensor.
    pub noise: f64,
    /// Name of the contact estimator.
    pub model: &'static str,
    /// Share of the points for which the estimator reports a position, 0 to 1. The points are those that the run
    /// recorded without noise by the sliding estimator.
    #[serde(rename = "told")]
    pub reported: f64,
    /// Mean distance of the reported positions from the exact surface (mm).
    pub mean_mm: Option<f64>,
    /// 95th percentile of that distance (mm).
    pub p95_mm: Option<f64>,
    /// Share of the reported positions within their own 95 % interval, 0 to 1.
    pub within_band: Option<f64>,
    /// Share of the reported positions that are outliers, 0 to 1.
    pub outliers: Option<f64>,
    /// Number of reported positions.
    pub tips: usize,
    /// Share of the reported positions that are reported as contacts of the shaft, 0 to 1.
    pub on_shaft: f64,
    /// Mean time of perception in a tick (µs), all whiskers together.
    pub tick_us: f64,
}

impl Document for EstimatorRow {
    const FORMAT: &'static str = "estimators";
}
