//! A recording as a world: it gives the recorded samples, whatever the command is.

use std::sync::Arc;

use vibrissa_lab::recording::SampledRun;
use vibrissa_lab::run::{Run, Watcher, drive};
use vibrissa_lab::stream::RunSetup;
use vibrissa_lab::trial::Trial;
use vibrissa_runtime::control::BindError;
use vibrissa_runtime::signal::{Command, Sample};
use vibrissa_world::geometry::{Point2, Pose};
use vibrissa_world::scene::{Goal, Scene, Stop};
use vibrissa_world::world::{Fault, World};

/// A recording that is replayed for a page.
#[derive(Debug)]
pub struct LiveReplay<'r> {
    recorded: &'r SampledRun,
    next: usize,
}

impl<'r> LiveReplay<'r> {
    /// A replay of a recorded run from its start.
    #[must_use]
    pub fn new(recorded: &'r SampledRun) -> Self {
        Self { recorded, next: 0 }
    }

    /// What a page has to know of the replay. `scene` is that of the recording, and `trial` simulates it again, if they are known.
    #[must_use]
    pub fn setup(&self, scene: Option<Scene>, trial: Option<Trial>) -> RunSetup {
        let SampledRun { identity, rig, program, policy, samples, .. } = self.recorded;
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
            start: self.first_pose(),
            trial,
            program: Arc::clone(program),
            policy: policy.clone(),
            no_guards: policy.is_none().then(|| no_guards.to_owned()),
            is_emulated: false,
            rig: rig.clone(),
        }
    }

    /// The first recorded pose. A faulty pose may be no number.
    fn first_pose(&self) -> Option<Pose> {
        let is_finite =
            |pose: &Pose| [pose.position.x, pose.position.y, pose.heading].iter().all(|part| part.is_finite());
        self.recorded.samples.iter().flatten().map(|sample| sample.body).find(is_finite)
    }

    /// Replays the recording. The result is `None` if the watcher ended the replay.
    ///
    /// # Errors
    /// [`BindError`] if the recorded rig does not have what the machine needs.
    pub fn run(mut self, watcher: &mut impl Watcher) -> Result<Option<Run>, BindError> {
        let period = self.recorded.rig.sensing.control_rate.recip();
        let stop = Stop::at(self.recorded.samples.len() as f64 * period);
        let control = self.recorded.control()?;
        Ok(drive(&mut self, control, Goal { stop: &stop, tunnels: &[] }, period, watcher))
    }
}

impl World for LiveReplay<'_> {
    fn advance(&mut self, _: &Command) -> Result<&[Sample], Fault> {
        let samples = self.recorded.samples.get(self.next);
        self.next += 1;
        Ok(samples.map(Vec::as_slice).unwrap_or_default())
    }

    fn body_touches(&self) -> bool {
        false
    }

    fn snapped_off(&self, _: usize) -> bool {
        false
    }

    /// The true tips are not recorded.
    fn tip(&self, _: usize) -> Point2 {
        Point2::new(f64::NAN, f64::NAN)
    }
}
