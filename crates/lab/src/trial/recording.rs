//! The samples of a trial.

use super::trial::{Trial, TrialResult};
use super::worlds::ExecuteError;
use vibrissa_runtime::signal::{Command, Sample};
use vibrissa_world::geometry::Point2;
use vibrissa_world::world::{Fault, OutOfPlane, Posture, World};

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
        let mut world = Recorder { world: self.world()?, ticks: Vec::new() };
        let result = self.run_in(&mut world)?;
        Ok(Recording { result, ticks: world.ticks })
    }
}

/// A world that keeps its samples.
struct Recorder {
    world: Box<dyn World>,
    ticks: Vec<Vec<Sample>>,
}

impl World for Recorder {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        let samples = self.world.advance(command)?;
        self.ticks.push(samples.to_vec());
        Ok(samples)
    }

    fn body_touches(&self) -> bool {
        self.world.body_touches()
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.world.snapped_off(whisker)
    }

    fn out_of_plane(&self, whisker: usize) -> Option<OutOfPlane> {
        self.world.out_of_plane(whisker)
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }

    fn posture(&self) -> Option<Posture> {
        self.world.posture()
    }
}
