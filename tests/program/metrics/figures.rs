//! The figures of a run that are guarded.

use serde_json::Value;
use vibrissa::results::RunResult;

/// The guarded figures, by their paths in `run --json`. Those that depend on the machine's speed are not among them.
pub(super) const FIGURES: [&str; 28] = [
    "error_mm.mean",
    "error_mm.std",
    "error_mm.p95",
    "error_mm.max",
    "error_mm.within_band",
    "error_mm.outliers",
    "error_mm.n",
    "coverage",
    "object_coverage",
    "hausdorff_mm",
    "axis_mm.mean",
    "passage.share",
    "passage.wall_coverage",
    "retrieval.count",
    "retrieval.radius_mm.mean",
    "retrieval.distance_mm.mean",
    "retrieval.time_s.mean",
    "corners.traced",
    "corners.place_mm.mean",
    "corners.place_mm.max",
    "corners.angle_rad.mean",
    "corners.time_s.mean",
    "corners.path_m.mean",
    "failsafes.count",
    "collisions.count",
    "collisions.time_s",
    "path_m",
    "sim_s",
];

/// Values of the figures in their order. `None` for a figure that the run does not have.
pub(super) type Values = [Option<f64>; FIGURES.len()];

/// The values of a run.
pub(super) fn values(result: &RunResult) -> Values {
    let document = serde_json::to_value(result).unwrap();
    FIGURES.map(|path| value(&document, path))
}

/// The number behind a path. `None` behind null. A key that is not there is a fault of the list.
fn value(document: &Value, path: &str) -> Option<f64> {
    let mut value = document;
    for key in path.split('.') {
        if value.is_null() {
            return None;
        }
        value = value.get(key).unwrap_or_else(|| panic!("a run has no figure `{path}`"));
    }
    assert!(value.is_null() || value.is_number(), "`{path}` is no figure");
    value.as_f64()
}
