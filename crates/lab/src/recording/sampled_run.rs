//! The samples of a recorded run, of a simulated one or of a robot.

use std::collections::BTreeMap;
use std::io::Read;
use std::sync::Arc;

use vibrissa_robot::drive::kept_for;
use vibrissa_robot::recording::{ReadError, Recording, Replayed, replay_observed};
use vibrissa_runtime::control::{BindError, Control};
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Sample;
use vibrissa_text::diagnostic::Source;

use super::read::RunRecording;

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
