//! The document of measurements of scale.

use serde::Serialize;

use crate::results::Document;

use super::sweep_cost::SweepCost;

/// Cost against size along all axes, and the cost of a large sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Scale {
    /// Number of measurements of every size. Times are medians.
    pub repeats: usize,
    /// Number of threads that the machine executes at the same time.
    pub processors: usize,
    /// The axes.
    pub axes: Vec<ScaleRow>,
    /// The cost of a large sweep in each simulator.
    pub sweeps: Vec<SweepCost>,
}

impl Document for Scale {
    const FORMAT: &'static str = "scale";
}

/// Cost against size along an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ScaleRow {
    /// The axis.
    pub axis: String,
    /// The simulator. `None` if the work has no runs.
    pub simulator: Option<String>,
    /// What the sizes count.
    pub unit: String,
    /// The work that is measured.
    pub work: String,
    /// The sizes, ascending.
    pub times: Vec<SizeTime>,
    /// Exponent `p` of a cost that grows as `size^p`, between the two largest sizes. `None` with one size.
    pub exponent: Option<f64>,
}

/// Time of the work of one size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SizeTime {
    /// The size.
    pub size: usize,
    /// Processor time of one thread. On the axis of the cores, wall time.
    pub time_s: f64,
}
