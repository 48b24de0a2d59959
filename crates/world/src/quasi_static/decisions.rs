//! What a run in the quasi-static simulator omits, with reasons.

use crate::world::{Decision, Verdict};

/// What the simulator omits, whatever the rig and the solids are.
#[must_use]
pub fn decisions() -> Vec<Decision> {
    vec![Decision {
        verdict: Verdict::LeftOut,
        subject: "pieces of outlines far from all whiskers".to_owned(),
        saves: Some("distances to these pieces; a bounding-box tree returns the near ones".to_owned()),
        why: "a link touches only pieces within its own length".to_owned(),
    }]
}
