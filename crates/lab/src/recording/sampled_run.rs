//! The samples of a recorded run, of a simulated one or of a robot.

use std::collections::BTreeMap;
use std::io::Read;
use std::sync::Arc;

use vibrissa_robot::drive::kept_for;
use vibrissa_robot::recording::{ReadError, Recording, Replayed, replay_observed};
use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::machine::{Artifact, Program};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Sample;
use vibrissa_text::diagnostic::Source;
use vibrissa_world::scene::{Goal, Stop};

use super::error::RecordError;
use super::read::RunRecording;
use super::recorder::Recorder;
use super::sampled_world::SampledWorld;
use super::setup::Setup;
use crate::run::{Run, Watcher, drive};

/// The samples of a recorded run, with the machine and the rig of its control.
#[derive(Debug)]
pub struct SampledRun {
    /// Names and hashes that identify the run.
    pub identity: BTreeMap<String, String>,
    /// The rig that control assumes.
    pub rig: Rig,
    /// The machine with the parameters of the run.
    pub program: Arc<Program>,
    /// The policy with those of the files that it uses. `None` if a compiled machine was recorded.
    pub policy: Option<Source>,
    /// The samples before each tick of the machine, oldest first.
    pub samples: Vec<Vec<Sample>>,
    /// For how long (s) control keeps values without a valid sample.
    kept_for: f64,
}

impl SampledRun {
    /// The samples of a robot's loop, decoded from its bytes as the robot does. The result also compares the replay with what the
    /// robot did.
    ///
    /// # Errors
    /// [`ReadError`] if the recording cannot be read, or if it does not have every input from the start of the run.
    pub fn of_robot<R: Read>(recording: Recording<R>) -> Result<(Self, Replayed), ReadError> {
        let (identity, setup) = (recording.identity().clone(), recording.setup());
        let (rig, program, kept_for) =
            (setup.config().rig.clone(), Arc::clone(setup.program()), kept_for(setup.config()));
        let mut samples = Vec::new();
        let replayed = replay_observed(recording, |tick| samples.push(tick.to_vec()))?;
        Ok((Self { identity, rig, program, policy: None, samples, kept_for }, replayed))
    }

    /// A control that takes the samples from the first one on.
    ///
    /// # Errors
    /// [`BindError`] if the rig does not have what the machine needs.
    pub fn control(&self) -> Result<Control, BindError> {
        let mut control = Control::simulated(&self.rig, Arc::clone(&self.program))?;
        control.keep_for(self.kept_for);
        Ok(control)
    }

    /// Runs the machine over the samples. The result is `None` if the watcher ended the run.
    ///
    /// # Errors
    /// [`BindError`] if the rig does not have what the machine needs.
    pub fn drive(&self, watcher: &mut impl Watcher) -> Result<Option<Run>, BindError> {
        let period = self.rig.sensing.control_rate.recip();
        let stop = Stop::at(self.samples.len() as f64 * period);
        let goal = Goal { stop: &stop, tunnels: &[] };
        Ok(drive(&mut SampledWorld::new(&self.samples), self.control()?, goal, period, watcher))
    }
}

impl From<&RunRecording> for SampledRun {
    fn from(recording: &RunRecording) -> Self {
        Self {
            identity: recording.setup.identity.clone(),
            rig: recording.setup.rig.clone(),
            program: Arc::new(recording.artifact.program.clone()),
            policy: recording.setup.policy.clone(),
            samples: recording.samples.clone(),
            kept_for: 0.0,
        }
    }
}

/// The recording of a run that another program has driven: the content of a file as [`Recorder`] writes it, without objects. `samples`
/// are those that `machine` has taken before each of its ticks, with this rig.
///
/// # Errors
/// [`RecordError`] if there was no tick, if the rig does not have what the machine needs, or if a value cannot be encoded.
pub fn record_samples(machine: &Artifact, rig: &Rig, samples: Vec<Vec<Sample>>) -> Result<Vec<u8>, RecordError> {
    if samples.is_empty() {
        return Err(RecordError::NoTick);
    }
    let setup = Setup::new(machine, rig, None, [])?;
    let sampled = SampledRun {
        identity: BTreeMap::new(),
        rig: rig.clone(),
        program: Arc::new(machine.program.clone()),
        policy: None,
        samples,
        kept_for: 0.0,
    };
    let mut recorder = Recorder::with_setup(setup, None);
    match sampled.drive(&mut recorder)? {
        Some(run) => recorder.finish(run.outcome.to_string(), &run),
        None => Err(RecordError::NoTick),
    }
}
