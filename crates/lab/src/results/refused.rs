//! The result of a run that could not begin.

use super::ending::Ending;
use super::{Collisions, ErrorMm, Failsafes, Identity, RunResult, TickUs};

impl RunResult {
    /// The result of a run that could not begin for this `reason`.
    #[must_use]
    pub fn refused(identity: Identity, reason: String) -> Self {
        let Identity { scenario, policy, true_tips, world, seed, mismatch, calibration, hash } = identity;
        Self {
            scenario,
            policy,
            true_tips,
            world,
            seed,
            mismatch,
            calibration,
            outcome: Ending::Refused,
            violations: vec![format!("{}: {reason}", Ending::Refused)],
            passed_but_for_tips: false,
            reason: Some(reason),
            final_state: String::new(),
            sim_s: 0.0,
            start_s: 0.0,
            wall_s: 0.0,
            realtime: None,
            error_mm: ErrorMm { mean: None, std: None, p95: None, max: None, within_band: None, outliers: None, n: 0 },
            largest_error: None,
            tip_error_mm: None,
            coverage: 0.0,
            object_coverage: 0.0,
            outline_coverages: Vec::new(),
            out_of_reach: 0.0,
            coverage_in_reach: 0.0,
            passage: None,
            hausdorff_mm: None,
            failsafes: Failsafes::default(),
            contracts: Vec::new(),
            retrieval: None,
            axis_mm: None,
            corners: None,
            states: Vec::new(),
            path_m: 0.0,
            path_ratio: 0.0,
            collisions: Collisions::default(),
            out_of_plane: None,
            inclination: None,
            whiskers: Vec::new(),
            tick_us: TickUs { mean: None, p99: None, max: None },
            hash,
        }
    }
}
