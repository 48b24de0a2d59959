//! The result of a run that could not begin.

use super::ending::Ending;
use super::section::Section;
use super::{Collisions, Failsafes, Identity, RunResult};

impl RunResult {
    /// The result of a run that could not begin for this `reason`.
    #[must_use]
    pub fn refused(identity: Identity, reason: String) -> Self {
        let Identity { scenario, policy, true_tips, world, seed, mismatch, calibration, hash, .. } = identity;
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
            duration: Section::empty(),
            start_s: 0.0,
            wall_s: 0.0,
            realtime: None,
            errors: Section::empty(),
            largest_error: None,
            traced: Section::empty(),
            outline_coverages: Vec::new(),
            reached: Section::empty(),
            failsafes: Failsafes::default(),
            contracts: Vec::new(),
            passed: Section::empty(),
            states: Vec::new(),
            path: Section::empty(),
            collisions: Collisions::none(),
            out_of_plane: None,
            inclination: None,
            whiskers: Vec::new(),
            latency: Section::empty(),
            friction: None,
            hash,
        }
    }
}
