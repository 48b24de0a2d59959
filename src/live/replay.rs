//! A recording as a world: it gives the recorded samples, whatever the command is.

use std::sync::Arc;

use vibrissa_lab::recording::RunRecording;
use vibrissa_lab::run::{Run, Watcher, drive};
use vibrissa_lab::stream::RunSetup;
use vibrissa_lab::trial::Trial;
use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::signal::{Command, Sample};
use vibrissa_world::geometry::{Point2, Pose};
use vibrissa_world::scene::{Goal, Stop};
use vibrissa_world::world::{Fault, World};

/// A recording that is replayed for a page.
#[derive(Debug)]
pub struct LiveReplay<'r> {
    recording: &'r RunRecording,
    next: usize,
}

impl<'r> LiveReplay<'r> {
    /// A replay of a recording from its start.
    #[must_use]
    pub fn new(recording: &'r RunRecording) -> Self {
        Self { recording, next: 0 }
    }

    /// What a page has to know of the replay. `trial` is that of the recording, if its scenario is known.
    #[must_use]
    pub fn setup(&self, trial: Option<Trial>) -> RunSetup {
        let (rig, program) = (self.recording.rig(), Arc::new(self.recording.program().clone()));
        let identity = |key: &str| self.recording.identity().get(key).cloned();
        let ticks = self.recording.samples().len();
        let no_guards = "the recording has no text of its policy; record a run of the policy itself to see its guards";
        RunSetup {
            command: "replay",
            scenario: identity("scenario").unwrap_or_default(),
            world: identity("world"),
            duration: Some(ticks as f64 / rig.sensing.control_rate),
            known_ticks: Some(ticks),
            scene: trial.as_ref().map(|trial| trial.scene.clone()),
            start: self.first_pose(),
            trial,
            program,
            policy: self.recording.policy().cloned(),
            no_guards: self.recording.policy().is_none().then(|| no_guards.to_owned()),
            is_emulated: false,
            rig: rig.clone(),
        }
    }

    /// The first recorded pose. A faulty pose may be no number.
    fn first_pose(&self) -> Option<Pose> {
        let is_finite =
            |pose: &Pose| [pose.position.x, pose.position.y, pose.heading].iter().all(|part| part.is_finite());
        self.recording.samples().iter().flatten().map(|sample| sample.body).find(is_finite)
    }

    /// Replays the recording. The result is `None` if the watcher ended the replay.
    ///
    /// # Errors
    /// [`BindError`] if the recorded rig does not have what the machine needs.
    pub fn run(mut self, watcher: &mut impl Watcher) -> Result<Option<Run>, BindError> {
        let (rig, program) = (self.recording.rig(), Arc::new(self.recording.program().clone()));
        let period = rig.sensing.control_rate.recip();
        let time = self.recording.samples().len() as f64 * period;
        let stop = Stop::at(time);
        let control = Control::simulated(rig, program)?;
        Ok(drive(&mut self, control, Goal { stop: &stop, tunnels: &[] }, period, watcher))
    }
}

impl World for LiveReplay<'_> {
    fn advance(&mut self, _: &Command) -> Result<&[Sample], Fault> {
        let samples = self.recording.samples().get(self.next);
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
