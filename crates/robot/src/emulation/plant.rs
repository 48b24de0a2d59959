//! The simulated robot that the emulated sensors belong to.

use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Sample};

/// A simulated platform with whiskers.
pub trait Plant {
    /// The state at the start.
    fn start(&self) -> PlantState;

    /// Simulates one sample period under `command`, and returns the state at its end.
    ///
    /// # Errors
    /// [`PlantFault`] if the simulation cannot go on. The run must end.
    fn advance(&mut self, command: &Command) -> Result<PlantState, PlantFault>;

    /// Receives the samples with which the machine has executed a tick, oldest first, before the observer of that tick is called.
    fn ticked(&mut self, samples: &[Sample]) {
        let _ = samples;
    }
}

/// The state of a plant that sensors measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantState {
    /// Pose of the platform's centre of mass in the world frame.
    pub pose: Pose,
    /// Base moment of each whisker (N m), counter-clockwise positive, in the order of the rig.
    pub base_moments: [f64; MAX_WHISKERS],
}

/// The reason why a simulation cannot go on.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct PlantFault(pub String);
