//! Broad phase: the pairs of geoms that MuJoCo tests for contact.
//!
//! Why: docs/decisions/mujoco-speed.md#near-pairs-are-updated-during-the-run.

use super::Reach;
use crate::geometry::Pose;
use vibrissa_runtime::rig::Rig;

use super::engine::{Engine, Member, Pair};

/// The distance (m) that any point of the rig may move before the pairs are searched again.
const SLACK: f64 = 2e-3;
/// An additional search distance (m) for integrators with inner stages. `RK4` evaluates contacts at intermediate
/// positions. It is not an upper bound of the motion within a long step. All other integrators evaluate contacts only
/// at the beginning of a step, directly after the search.
const WITHIN_STEP: f64 = 1e-3;

/// The pairs of links and convex parts that are near each other.
#[derive(Debug, Default)]
pub(super) struct BroadPhase {
    /// The pose of the platform and the joint angles of all whiskers at the last search.
    since: Option<(Pose, Vec<Vec<[f64; 2]>>)>,
    pairs: Vec<Pair>,
}

impl BroadPhase {
    /// Discards the last search, because the model has been replaced.
    pub(super) fn invalidate(&mut self) {
        self.since = None;
    }

    /// Returns the pairs that may touch, or `None` if they are still those of the last search.
    pub(super) fn changed_pairs(&mut self, rig: &Rig, reach: &Reach, engine: &Engine) -> Option<&[Pair]> {
        if self.since.as_ref().is_some_and(|(body, angles)| is_near(rig, reach, engine, body, angles)) {
            return None;
        }
        let body = engine.body();
        self.pairs.clear();
        let parts = reach.near_body(&rig.platform, &body, SLACK + WITHIN_STEP);
        self.pairs.extend(parts.into_iter().map(|part| Pair { of: Member::Body, part }));
        for (index, whisker) in engine.scope.flexible(rig) {
            let links = engine.links(rig, index).map(|link| (link.start, link.direction));
            let near = reach.near_links(whisker, links, SLACK + WITHIN_STEP);
            self.pairs.extend(near.map(|(link, part)| Pair { of: Member::Link(index, link), part }));
        }
        let angles = (0..rig.whiskers.len()).map(|whisker| engine.angles(whisker).collect()).collect();
        self.since = Some((body, angles));
        Some(&self.pairs)
    }
}

/// True if no point has moved more than [`SLACK`] since the last search.
fn is_near(rig: &Rig, reach: &Reach, engine: &Engine, body: &Pose, angles: &[Vec<[f64; 2]>]) -> bool {
    let motion = reach.motion_bound(body, &engine.body());
    let swings = angles.iter().enumerate().map(|(whisker, angles)| engine.swing_since(rig, whisker, angles));
    motion + swings.fold(0.0, f64::max) <= SLACK
}
