//! The controller: perception, machine, steering, and a map if the policy uses it or a caller asks for it.

use std::sync::Arc;

use crate::machine::{Machine, Observer, OnlySimulated, Program, Tick};
use crate::map::{Map, MapError, MapSettings, MappedPerception};
use crate::math;
use crate::motion::{ServoLead, Steering};
use crate::percept::{Perception, PerceptionError};
use crate::rig::{Rig, UnknownWhisker};
use crate::signal::{Command, Sample};

/// An error of binding a policy to a rig.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BindError {
    /// The rig lacks a whisker.
    #[error(transparent)]
    Whisker(#[from] UnknownWhisker),
    /// The rig has no valid perception for the policy.
    #[error(transparent)]
    Perception(#[from] PerceptionError),
    /// The policy can only run in a simulator.
    #[error(transparent)]
    OnlySimulated(#[from] OnlySimulated),
    /// The settings give no map.
    #[error(transparent)]
    Map(#[from] MapError),
}

/// Time (s) over which base angles and the pose are kept in ticks without a valid one, unless
/// [`Control::keep_for`] changes it. It bridges single ticks, and the time that a supervisor needs to notice a fault.
const KEPT_FOR: f64 = 0.1;

/// The control loop of one rig under one policy. It contains everything that runs at the control rate.
#[derive(Debug, Clone)]
pub struct Control {
    perception: Perception,
    machine: Machine,
    steering: Steering,
    servo_lead: ServoLead,
    /// The map, if there is one.
    map: Option<Box<Map>>,
    /// The command that holds until the next tick.
    command: Command,
}

impl Control {
    /// Creates the controller of `rig` under `program`, at the start of a run.
    ///
    /// # Errors
    /// [`BindError`] if the rig lacks something that the policy needs. No rig has true tip positions.
    pub fn new(rig: &Rig, program: Arc<Program>) -> Result<Self, BindError> {
        program.check_for_robot()?;
        Self::simulated(rig, program)
    }

    /// Creates the controller of a simulated `rig`, whose samples have the [true tips](crate::signal::TrueTip) if the
    /// program uses them. Without them, the contact estimator `truth` gives no contact.
    ///
    /// # Errors
    /// [`BindError`] if the rig lacks something that the policy needs.
    pub fn simulated(rig: &Rig, program: Arc<Program>) -> Result<Self, BindError> {
        let whiskers = rig.fitted(&program.whiskers, &program.optional)?;
        let mut perception = Perception::new(rig, &whiskers, &program.contact_estimators)?
            .with_contours(program.keypoints, &program.contours);
        perception.keep_for(KEPT_FOR);
        let map = if program.uses_map() {
            Some(Box::new(Map::new(rig, &whiskers, MapSettings::for_rig(rig))?))
        } else {
            None
        };
        Ok(Self {
            perception,
            steering: Steering::new(rig, &whiskers),
            servo_lead: ServoLead::new(rig),
            machine: Machine::new(program),
            map,
            command: Command::STOP,
        })
    }

    /// Gives the controller a map of `rig`, which must be its own rig, with these settings. Without a call there is one only if
    /// the policy uses it ([`Program::uses_map`]), with the settings for the rig. The map never changes a command by itself.
    ///
    /// # Errors
    /// [`BindError`] if the settings give no map.
    pub fn with_map(mut self, rig: &Rig, settings: MapSettings) -> Result<Self, BindError> {
        let program = self.machine.program();
        let whiskers = rig.fitted(&program.whiskers, &program.optional)?;
        self.map = Some(Box::new(Map::new(rig, &whiskers, settings)?));
        Ok(self)
    }

    /// Keeps base angles and the pose over ticks without a valid one for this time (s), if it is longer than 0.1 s. After it
    /// they are NaN, so that the fallback transition of the policy acts.
    pub fn keep_for(&mut self, time: f64) {
        self.perception.keep_for(math::max(KEPT_FOR, time));
    }

    /// Executes one tick and returns the command until the next tick, and the output of the machine.
    ///
    /// `samples` are those since the last tick, oldest first. The function allocates no memory.
    pub fn tick(&mut self, samples: &[Sample]) -> (Command, Tick) {
        self.tick_under(samples, &mut ())
    }

    /// Executes one [`tick`](Self::tick). `observer` receives the guards that are tried and the transitions that are taken.
    pub fn tick_observed(&mut self, samples: &[Sample], observer: &mut dyn Observer) -> (Command, Tick) {
        // A type parameter would compile the tick in the crate of every caller, with the optimisation of that crate.
        self.tick_under(samples, observer)
    }

    fn tick_under<O: Observer + ?Sized>(&mut self, samples: &[Sample], observer: &mut O) -> (Command, Tick) {
        self.perception.update(samples);
        let tick = match &mut self.map {
            Some(map) => {
                self.machine.tick_observed(&mut MappedPerception { perception: &mut self.perception, map }, observer)
            }
            None => self.machine.tick_observed(&mut self.perception, observer),
        };
        // After the machine, which records tips.
        if let Some(map) = &mut self.map {
            map.update(&self.perception, self.perception.pose(), self.command);
        }
        let command = self.steering.command(&tick.action, self.perception.pose_at_effect());
        let command = self.servo_lead.next(command, self.perception.servos());
        self.replace_command(command);
        (command, tick)
    }

    /// Continues with another program of the same policy, such as one with other values of parameters. See
    /// [`Machine::continue_with`].
    pub fn continue_with(&mut self, program: Arc<Program>) {
        match &mut self.map {
            Some(map) => {
                self.machine.continue_with(program, &mut MappedPerception { perception: &mut self.perception, map });
            }
            None => self.machine.continue_with(program, &mut self.perception),
        }
    }

    /// Tells perception that the platform executes this command instead of that of the newest tick.
    pub fn replace_command(&mut self, command: Command) {
        self.command = command;
        self.perception.command(command);
    }

    /// The perception of this controller.
    #[must_use]
    pub fn perception(&self) -> &Perception {
        &self.perception
    }

    /// The map of this controller, if it has one.
    #[must_use]
    pub fn map(&self) -> Option<&Map> {
        self.map.as_deref()
    }

    /// The map of this controller, if it has one, to set a goal or to report a failure.
    pub fn map_mut(&mut self) -> Option<&mut Map> {
        self.map.as_deref_mut()
    }

    /// The machine of this controller.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }
}
