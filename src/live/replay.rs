//! What a page has to know of a recording that it shows.

use std::sync::Arc;

use vibrissa_lab::recording::SampledRun;
use vibrissa_lab::stream::RunSetup;
use vibrissa_lab::trial::Trial;
use vibrissa_world::geometry::Pose;
use vibrissa_world::scene::Scene;

/// What a page has to know of the replay. `scene` is that of the recording, and `trial` simulates it again, if they are known.
#[must_use]
pub fn replay_setup(recorded: &SampledRun, scene: Option<Scene>, trial: Option<Trial>) -> RunSetup {
    let SampledRun { identity, rig, program, policy, samples, .. } = recorded;
    let ticks = samples.len();
    let no_guards =
        "the recording has no text of its policy; give it with `--policy`, or record a run of the policy itself";
    RunSetup {
        command: "replay",
        scenario: identity.get("scenario").or_else(|| identity.get("robot")).cloned().unwrap_or_default(),
        world: identity.get("world").cloned(),
        duration: Some(ticks as f64 / rig.sensing.control_rate),
        known_ticks: Some(ticks),
        scene,
        start: first_pose(recorded),
        trial,
        program: Arc::clone(program),
        policy: policy.clone(),
        no_guards: policy.is_none().then(|| no_guards.to_owned()),
        is_emulated: false,
        rig: rig.clone(),
    }
}

/// The first recorded pose. A faulty pose may be no number.
fn first_pose(recorded: &SampledRun) -> Option<Pose> {
    let is_finite = |pose: &Pose| [pose.position.x, pose.position.y, pose.heading].iter().all(|part| part.is_finite());
    recorded.samples.iter().flatten().map(|sample| sample.body).find(is_finite)
}
