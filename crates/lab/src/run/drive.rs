//! A whole run.

use std::ops::ControlFlow;
use std::time::Duration;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Observer;
use vibrissa_runtime::signal::Sample;
use vibrissa_world::scene::{Goal, Outcome};
use vibrissa_world::world::World;

use super::contract::ContractRecord;
use super::run_map::RunMap;
use super::stepped_run::{Step, SteppedRun};
use super::trace::Trace;

/// The result of the control loop.
#[derive(Debug, Clone)]
pub struct Run {
    /// The outcome.
    pub outcome: Outcome,
    /// Reason of the outcome, such as the text of the policy's `Success` or `Failure`. `None` if a stop condition completed
    /// the run.
    pub reason: Option<String>,
    /// Name of the last state.
    pub final_state: String,
    /// The trace.
    pub trace: Trace,
    /// The map by touch. `None` for a policy that uses none.
    pub map: Option<Box<RunMap>>,
    /// The contracts of the policy that the run watched.
    pub contracts: Vec<ContractRecord>,
    /// Wall time of the loop alone.
    pub wall: Duration,
    /// Wall time from the request of the run to the end of its first tick. The control loop sets it to the time of the
    /// first samples and their tick. Its caller adds the time of reading, compiling and building.
    pub start: Duration,
    /// Wall time of each control tick: perception, machine and motion.
    pub tick_times: Vec<Duration>,
}

/// Watches a run, and may stop it.
pub trait Watcher: Observer {
    /// Receives the samples of the control period before every tick, oldest first.
    fn before_tick(&mut self, samples: &[Sample]) {
        let _ = samples;
    }

    /// Receives the trace and the world after every tick, before [`after_tick`](Self::after_tick). The world has what no
    /// sensor reports. Emulated runs and replays do not call it.
    fn in_world(&mut self, trace: &Trace, world: &dyn World) {
        let _ = (trace, world);
    }

    /// Receives the trace after every tick. A break ends the run.
    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        let _ = trace;
        ControlFlow::Continue(())
    }
}

/// Watches nothing.
impl Watcher for () {}

/// Passes everything on to a watcher, if there is one.
impl<W: Watcher> Watcher for Option<W> {
    fn before_tick(&mut self, samples: &[Sample]) {
        if let Some(watcher) = self {
            watcher.before_tick(samples);
        }
    }

    fn in_world(&mut self, trace: &Trace, world: &dyn World) {
        if let Some(watcher) = self {
            watcher.in_world(trace, world);
        }
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        self.iter_mut().try_for_each(|watcher| watcher.after_tick(trace))
    }
}

/// Passes everything on to the first watcher, and then to the second one.
impl<A: Watcher, B: Watcher> Watcher for (A, B) {
    fn before_tick(&mut self, samples: &[Sample]) {
        self.0.before_tick(samples);
        self.1.before_tick(samples);
    }

    fn in_world(&mut self, trace: &Trace, world: &dyn World) {
        self.0.in_world(trace, world);
        self.1.in_world(trace, world);
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        self.0.after_tick(trace)?;
        self.1.after_tick(trace)
    }
}

/// A watcher that receives the trace alone.
#[derive(Debug)]
pub struct Progress<F>(pub F);

impl<F> Observer for Progress<F> {}

impl<F: FnMut(&Trace) -> ControlFlow<()>> Watcher for Progress<F> {
    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        (self.0)(trace)
    }
}

/// Runs `control` in `world` until `goal`. `watcher` may stop the run earlier. Then the result is `None`.
pub fn drive(
    world: &mut dyn World,
    control: Control,
    goal: Goal<'_>,
    period: f64,
    watcher: &mut dyn Watcher,
) -> Option<Run> {
    let mut run = SteppedRun::new(control, goal, period);
    loop {
        match run.step(world, watcher) {
            Step::Running => {}
            Step::Ended(ending) => return Some(run.finish(ending)),
            Step::Interrupted => return None,
        }
    }
}
