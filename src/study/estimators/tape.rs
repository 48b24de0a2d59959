//! The samples of a run.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::geometry::Point2;
use crate::run::{Run, drive};
use crate::scene::{Scene, WorldKind};
use crate::study::{ExecuteError, build};
use crate::world::{Fault, World};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

/// The samples of a run, and what happened in it.
pub(in crate::study) struct Tape {
    /// One list a tick, as many as the trace has.
    pub(super) ticks: Vec<Vec<Sample>>,
    pub(in crate::study) run: Run,
}

impl Tape {
    /// Runs a policy in a scene, in a `world`. Perception takes the rig to be the one that is `perceived`.
    pub(in crate::study) fn record(
        scene: &Scene,
        perceived: &Rig,
        program: Arc<Program>,
        world: WorldKind,
    ) -> Result<Self, ExecuteError> {
        let control = Control::new(perceived, program)?;
        let world = build(scene, world.into(), scene.seed)?;
        let mut world = Recorder { world, ticks: Vec::new() };
        let period = 1.0 / scene.rig.sensing.control_rate;
        let run = drive(&mut world, control, &scene.stop, period, |_| ControlFlow::Continue(()));
        Ok(Self { run: run.ok_or(ExecuteError::Interrupted)?, ticks: world.ticks })
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

    fn springs(&self, whisker: usize) -> bool {
        self.world.springs(whisker)
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }
}
