//! The controller: everything between a sample and a command.

use std::sync::Arc;

use crate::machine::{Machine, Program, Tick};
use crate::motion::Steering;
use crate::percept::{Perception, PerceptionError};
use crate::rig::{Rig, UnknownWhisker};
use crate::signal::{Command, Sample};

/// Why a policy cannot control a rig.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BindError {
    /// The rig lacks a whisker.
    #[error(transparent)]
    Whisker(#[from] UnknownWhisker),
    /// The rig cannot be perceived.
    #[error(transparent)]
    Perception(#[from] PerceptionError),
}

/// Perception, machine and steering of one rig under one policy: all that runs at the control rate.
#[derive(Debug, Clone)]
pub struct Control {
    perception: Perception,
    machine: Machine,
    steering: Steering,
}

impl Control {
    /// The controller of `rig` under `program`, at the start of a run.
    ///
    /// # Errors
    /// [`BindError`] when the rig does not have what the policy needs.
    pub fn new(rig: &Rig, program: Arc<Program>) -> Result<Self, BindError> {
        let whiskers = rig.fitted(&program.whiskers, &program.optional)?;
        Ok(Self {
            perception: Perception::new(rig, &whiskers, &program.contact_estimators)?,
            steering: Steering::new(rig, &whiskers),
            machine: Machine::new(program),
        })
    }

    /// One tick: takes the samples since the last one, oldest first, and gives the command until the next, with what the
    /// machine gave. Allocates nothing.
    pub fn tick(&mut self, samples: &[Sample]) -> (Command, Tick) {
        self.perception.update(samples);
        let tick = self.machine.tick(&mut self.perception);
        let command = self.steering.command(&tick.action, self.perception.pose());
        self.perception.command(command);
        (command, tick)
    }

    /// What it perceives.
    #[must_use]
    pub fn perception(&self) -> &Perception {
        &self.perception
    }

    /// Its machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }
}
