//! Starts from which an object can be felt.

use crate::geometry::{Pose, unit};
use crate::scene::Scene;
use crate::scene::clearance::{Overlap, overlap};

/// How far a platform goes straight ahead until it should have touched something (m).
const REACH: f64 = 0.8;
/// How far it goes from look to look (m).
const STEP: f64 = 4e-3;
/// How far it can go on from the first touch before its body does (m).
const WARNING: f64 = 0.02;

/// Whether a rig that goes straight ahead from `start` first touches something with a whisker, early enough for its body not to:
/// no policy can feel what the nose meets first.
pub(super) fn is_felt(scene: &Scene, start: &Pose) -> bool {
    let touched = |distance: f64| {
        let pose = Pose { position: start.position + distance * unit(start.heading), ..*start };
        let touches = scene.solids.iter().filter_map(|solid| overlap(&scene.rig, &pose, solid.outline()));
        touches.fold(None, |first, touch| if first == Some(Overlap::Platform) { first } else { Some(touch) })
    };
    let mut distance = 0.0;
    while distance < REACH {
        distance += STEP;
        if touched(distance).is_some() {
            return touched(distance + WARNING) != Some(Overlap::Platform);
        }
    }
    false
}
