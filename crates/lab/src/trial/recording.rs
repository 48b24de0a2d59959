//! The samples of a trial.

use super::trial::{Trial, TrialResult};
use super::worlds::ExecuteError;
use vibrissa_runtime::signal::Sample;
use vibrissa_world::world::{Observed, World};

/// The samples of a trial, and its result.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The samples of each tick. There are as many ticks as in the trace.
    pub ticks: Vec<Vec<Sample>>,
    /// The result.
    pub result: TrialResult,
}

impl Trial {
    /// Runs the trial and keeps the samples.
    ///
    /// # Errors
    /// [`ExecuteError`] if the run cannot begin.
    pub fn record(&self) -> Result<Recording, ExecuteError> {
        let mut ticks = Vec::new();
        let keep = |_: &dyn World, samples: &mut Vec<Sample>| ticks.push(samples.clone());
        let result = self.run_in(&mut Observed::new(self.world()?, keep))?;
        Ok(Recording { ticks, result })
    }
}
