//! Looking for contacts of what is near alone.

use super::Reach;
use crate::geometry::Pose;
use vibrissa_runtime::rig::Rig;

use super::engine::{Engine, Member, Pair};

/// How far (m) anything of the rig may go before what is near is looked up anew.
const SLACK: f64 = 2e-3;
/// How much farther than that (m) is looked, for integrators with inner stages: `RK4` looks for contacts at places that it comes to within
/// a step. This is no bound on the way there, which may be longer in a step of milliseconds while a whisker springs; all others
/// look for contacts only where a step begins, where what is near has just been looked up.
const WITHIN_STEP: f64 = 1e-3;

/// What names the pairs of a model: links and parts that are near each other.
#[derive(Debug, Default)]
pub(super) struct Lookout {
    /// The platform's pose when they were looked up, and the angles of the joints of all whiskers.
    since: Option<(Pose, Vec<Vec<f64>>)>,
    pairs: Vec<Pair>,
}

impl Lookout {
    /// What is near must be looked up anew: the model is another.
    pub(super) fn forget(&mut self) {
        self.since = None;
    }

    /// The pairs of what may touch, unless they are what they were.
    pub(super) fn changed(&mut self, rig: &Rig, reach: &Reach, engine: &Engine) -> Option<&[Pair]> {
        if self.since.as_ref().is_some_and(|(body, angles)| is_near(rig, reach, engine, body, angles)) {
            return None;
        }
        let body = engine.body();
        self.pairs.clear();
        let parts = reach.near_body(&rig.platform, &body, SLACK + WITHIN_STEP);
        self.pairs.extend(parts.into_iter().map(|part| Pair { of: Member::Body, part }));
        for (index, whisker) in engine.scope.flexible(rig) {
            let near = reach.near_links(whisker, engine.links(rig, index), SLACK + WITHIN_STEP);
            self.pairs.extend(near.map(|(link, part)| Pair { of: Member::Link(index, link), part }));
        }
        let angles = (0..rig.whiskers.len()).map(|whisker| engine.angles(whisker).collect()).collect();
        self.since = Some((body, angles));
        Some(&self.pairs)
    }
}

/// Whether nothing has gone farther than [`SLACK`] from where it was.
fn is_near(rig: &Rig, reach: &Reach, engine: &Engine, body: &Pose, angles: &[Vec<f64>]) -> bool {
    let way = reach.way(body, &engine.body());
    let swings = angles.iter().enumerate().map(|(whisker, angles)| engine.swing_since(rig, whisker, angles));
    way + swings.fold(0.0, f64::max) <= SLACK
}
