//! The watcher of a run that a page shows.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Observer;
use vibrissa_runtime::signal::Sample;

use super::error::LiveError;
use super::hub::{Hub, Pace};
use super::log::{Executed, RunLog};
use vibrissa_lab::inspect::Breakpoints;
use vibrissa_lab::recording::RecordedFrame;
use vibrissa_lab::results::Ending;
use vibrissa_lab::run::{Run, Trace, Watcher};
use vibrissa_lab::stream::Frames;
use vibrissa_lab::stream::RunSetup;
use vibrissa_lab::stream::Shadow;
use vibrissa_lab::stream::TickResult;
use vibrissa_lab::stream::hello;
use vibrissa_lab::stream::message::Timing;
use vibrissa_lab::trial::TrialResult;

/// Passes the ticks of a run on to the page, and makes the run wait where a user asked for it.
pub struct LiveWatcher<'i> {
    hub: Arc<Hub>,
    log: Arc<RunLog>,
    setup: RunSetup,
    shadow: Shadow,
    frames: Frames,
    pace: Pace,
    breaks_version: u64,
    samples: Vec<Sample>,
    began_tick: Instant,
    /// The end of the tick before, unless the run was paused since then.
    last_tick: Option<Instant>,
    /// True if a paused run has to end.
    is_over: Box<dyn FnMut() -> bool + 'i>,
    /// True if it had to end before its first tick.
    has_to_end: bool,
}

impl<'i> LiveWatcher<'i> {
    /// The watcher of a run that begins. `is_over` ends a paused run, for instance because a file has changed. The result has messages
    /// for the user about breakpoints that the policy does not have.
    pub(super) fn new(
        hub: &Arc<Hub>,
        setup: RunSetup,
        (speed, is_paused): (Option<f64>, bool),
        is_over: impl FnMut() -> bool + 'i,
    ) -> Result<(Self, Vec<String>), LiveError> {
        let breaks = hub.breakpoints();
        let (policy, faults) = explained(&setup, &breaks.texts)?;
        let control = control(&setup, policy.as_deref())?;
        let bound: Vec<usize> = control.perception().fitted().map(|(_, in_rig)| in_rig).collect();
        let (mut hello, numbers, changeable) = hello(&setup, control.machine().program(), policy.as_deref(), &bound);
        hello.run = hub.next_run();
        let infos = hello.breakpoints.clone();
        let shadow = Shadow::new(control, policy);
        let truth = setup.scene.as_ref().map(|scene| scene.truth.clone());
        let frames = Frames::new(setup.rig.clone(), bound, truth);
        let log = Arc::new(RunLog::new((hello, numbers, changeable), &setup, &shadow));
        hub.set_breakpoints(breaks.texts, infos);
        let breaks_version = hub.breakpoints_version();
        hub.begin(Arc::clone(&log), is_paused);
        let watcher = Self {
            hub: Arc::clone(hub),
            log,
            setup,
            shadow,
            frames,
            pace: Pace::new(speed),
            breaks_version,
            samples: Vec::new(),
            began_tick: Instant::now(),
            last_tick: None,
            is_over: Box::new(is_over),
            has_to_end: false,
        };
        Ok((watcher, faults))
    }

    /// Tells the page the outcome of the run, and what is missing if it ended.
    pub fn finish(self, result: &TrialResult) {
        let missing = result.violations.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        let ending = result.ending();
        let reason = if ending == Ending::Ended { Some(missing) } else { result.run.reason.clone() };
        self.hub.finish(ending.name(), reason, self.frames.metrics());
    }

    /// Tells the page how a run ended whose scenario is not known.
    pub fn finish_unjudged(self, run: &Run) {
        self.hub.finish(run.outcome.name(), run.reason.clone(), self.frames.metrics());
    }

    /// Takes new breakpoints over. The control loop that explains guards is then made again, and executes all ticks until now.
    fn update_breakpoints(&mut self) {
        let breaks = self.hub.breakpoints();
        if breaks.version == self.breaks_version {
            return;
        }
        self.breaks_version = breaks.version;
        // The page gets its error where it adds a breakpoint.
        let Ok((policy, _)) = explained(&self.setup, &breaks.texts) else { return };
        let Ok(control) = control(&self.setup, policy.as_deref()) else { return };
        let mut shadow = Shadow::new(control, policy);
        self.log.past().repeat(&mut shadow);
        self.shadow = shadow;
    }

    /// Waits until the next tick may begin.
    fn wait(&mut self, time: f64) -> ControlFlow<()> {
        if self.hub.wait(&mut self.pace, time, &mut self.is_over)? {
            // The time of a pause is no control period.
            self.last_tick = None;
        }
        self.update_breakpoints();
        ControlFlow::Continue(())
    }

    /// The times of the newest tick. Those of an emulated loop are the perceived ones: a late tick shows an overload. A replay has
    /// none, because its wall times are those of another computer than the one that ran the loop.
    fn timing(&mut self, trace: &Trace) -> Option<Timing> {
        if self.setup.is_emulated {
            let [.., before, newest] = trace.ticks.as_slice() else { return None };
            let period = newest.time - before.time;
            let overload = period > 1.5 * self.log.facts.hello.control_period;
            return Some(Timing { period: Some(period), used: 0.0, overload });
        }
        if self.setup.command == "replay" {
            return None;
        }
        let now = Instant::now();
        let used = now.duration_since(self.began_tick).as_secs_f64();
        let period = self.last_tick.replace(now).map(|last| now.duration_since(last).as_secs_f64());
        Some(Timing { period, used, overload: used > self.log.facts.hello.control_period })
    }
}

/// The explained policy of a run with breakpoints, as far as it has them, and what is wrong with the others.
fn explained(setup: &RunSetup, texts: &[String]) -> Result<(Option<Arc<Breakpoints>>, Vec<String>), LiveError> {
    let Some(source) = &setup.policy else { return Ok((None, Vec::new())) };
    let (policy, others) = Breakpoints::possible(source, texts).map_err(|_| LiveError::Explain)?;
    let fault = |text: &String| format!("the policy `{}` has no breakpoint `{text}`", setup.program.name);
    Ok((Some(Arc::new(policy)), others.iter().map(fault).collect()))
}

/// The control loop that explains guards, at the start of a run.
fn control(setup: &RunSetup, policy: Option<&Breakpoints>) -> Result<Control, LiveError> {
    let program = match policy {
        Some(policy) => Arc::new(policy.explained.with_parameters_of(&setup.program)),
        None => Arc::clone(&setup.program),
    };
    Ok(Control::simulated(&setup.rig, program)?)
}

impl Observer for LiveWatcher<'_> {}

impl Watcher for LiveWatcher<'_> {
    fn before_tick(&mut self, samples: &[Sample]) {
        self.samples.clear();
        self.samples.extend_from_slice(samples);
        if self.log.past().len() == 0 {
            // A run that is to begin later waits here. If it has to end instead, it does so after its first tick.
            self.has_to_end = self.wait(0.0).is_break();
        }
        self.began_tick = Instant::now();
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        let timing = self.timing(trace);
        let (_, hit) = self.shadow.tick(&self.samples);
        let Some(tick) = trace.ticks.last() else { return ControlFlow::Continue(()) };
        let Some(frame) =
            self.frames.frame(trace, (&self.shadow, &self.log.facts.numbers, &self.log.facts.hello.chart), timing)
        else {
            return ControlFlow::Continue(());
        };
        self.log.names.get_or_init(|| without_ticks(trace));
        let (time, taken) = (tick.time, frame.taken.last().copied());
        let raw = self.hub.has_foxglove_viewers().then(|| RecordedFrame::last(trace, self.samples.clone())).flatten();
        let state = tick.state.filter(|_| !self.shadow.has_ended());
        let result = TickResult { time, state, taken, command: tick.command };
        self.log.past().push(Executed { frame, result, samples: &self.samples, shadow: &self.shadow, raw });
        if let Some(breakpoint) = hit {
            self.hub.pause_at(breakpoint);
        }
        if self.has_to_end { ControlFlow::Break(()) } else { self.wait(time) }
    }
}

/// A trace with the names of a run and no ticks.
fn without_ticks(trace: &Trace) -> Trace {
    let mut empty = Trace { ticks: Vec::new(), marks: Vec::new(), messages: Vec::new(), ..trace.clone() };
    empty.plots.iter_mut().for_each(|plot| plot.values.clear());
    empty
}
