//! A run that its caller steps.

use std::sync::Arc;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::signal::Command;
use vibrissa_world::scene::Goal;
use vibrissa_world::world::World;

use super::drive::{Run, Watcher};
use super::monitor::{Ending, Monitor};
use super::stopwatch::Stopwatch;
use super::trace::Trace;

/// A run that its caller steps, one control period at a time.
///
/// ```
/// use std::sync::Arc;
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_lab::run::Step;
/// use vibrissa_world::scene::WorldKind;
/// use vibrissa_lab::built_in;
/// use vibrissa_language as policy;
/// use vibrissa_world::scenario;
/// use vibrissa_lab::trial::Trial;
/// let disk = built_in::SCENARIOS[0];
/// let scene = scenario::read(&Source::new(disk.path, disk.text)).unwrap();
/// let text = std::fs::read_to_string("policies/bang.fsm").unwrap();
/// let program = policy::compile(&Source::new("bang.fsm", text)).unwrap();
/// let mut trial = Trial::new(scene, Arc::new(program));
/// trial.world = WorldKind::QuasiStatic.into();
///
/// let (mut world, mut run) = (trial.world().unwrap(), trial.begin().unwrap());
/// let ending = loop {
///     match run.step(world.as_mut(), &mut ()) {
///         Step::Running => println!("{:?}", run.command()),
///         Step::Ended(ending) => break ending,
///         Step::Interrupted => unreachable!("the watcher `()` stops no run"),
///     }
/// };
/// let result = trial.scored(run.finish(ending));
/// assert_eq!(result.score.error, trial.run().unwrap().score.error);
/// ```
#[derive(Debug)]
pub struct SteppedRun {
    control: Control,
    monitor: Monitor,
    command: Command,
}

/// The state of a run after a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// The run goes on.
    Running,
    /// The run has ended.
    Ended(Ending),
    /// The watcher stopped the run.
    Interrupted,
}

impl SteppedRun {
    /// A run of `control` until `goal`, with this control period (s). The first command is to stand still.
    #[must_use]
    pub fn new(control: Control, goal: Goal<'_>, period: f64) -> Self {
        Self { monitor: Monitor::new(&control, goal, period), control, command: Command::STOP }
    }

    /// Simulates one control period under the current command, and executes one tick of the control loop. Its command
    /// is the next one.
    pub fn step(&mut self, world: &mut dyn World, watcher: &mut dyn Watcher) -> Step {
        let samples = match world.advance(&self.command) {
            Ok(samples) => samples,
            Err(fault) => return Step::Ended(self.monitor.crashed(&fault)),
        };
        watcher.before_tick(samples);
        let before_tick = Stopwatch::start();
        let (command, ticked) = self.control.tick_observed(samples, watcher);
        self.monitor.tick_took(before_tick.elapsed());
        self.command = command;
        let ending = self.monitor.observe(&self.control, command, &ticked, world);
        watcher.in_world(self.monitor.trace(), world);
        if watcher.after_tick(self.monitor.trace()).is_break() {
            return Step::Interrupted;
        }
        ending.map_or(Step::Running, Step::Ended)
    }

    /// Replaces the command of the newest tick, so that the caller steers the platform instead of the policy.
    pub fn replace_command(&mut self, command: Command) {
        self.command = command;
        self.control.replace_command(command);
        self.monitor.replace_command(command);
    }

    /// Continues with another program of the same policy, such as one with other values of parameters.
    pub fn continue_with(&mut self, program: Arc<Program>) {
        self.control.continue_with(program);
    }

    /// The command of the newest tick.
    #[must_use]
    pub fn command(&self) -> Command {
        self.command
    }

    /// The control loop.
    #[must_use]
    pub fn control(&self) -> &Control {
        &self.control
    }

    /// The trace so far.
    #[must_use]
    pub fn trace(&self) -> &Trace {
        self.monitor.trace()
    }

    /// The finished run.
    #[must_use]
    pub fn finish(self, ending: Ending) -> Run {
        self.monitor.finish(&self.control, ending)
    }
}
