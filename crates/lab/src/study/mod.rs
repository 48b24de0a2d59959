//! Experiments over many trials.

pub mod bench;
pub mod compare;
pub mod estimators;
pub mod latency;
pub mod pareto;
pub mod scale;
pub mod stress;
pub mod timing;
pub mod worlds;

pub use crate::calibration::{ArrayCalibration, ArrayCalibrationError};
