//! What the run, the page and the command line share: the current run, its pauses and its breakpoints.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::log::RunLog;
use vibrissa_lab::stream::message::{BreakpointInfo, Metrics, Status};

/// While a run waits, it looks this often whether it has to end.
const LOOK: Duration = Duration::from_millis(20);
/// A run that is later than this does not catch up.
const LATE: Duration = Duration::from_millis(200);

/// The state that all threads share.
#[derive(Default)]
pub(super) struct Hub {
    shared: Mutex<Shared>,
    changed: Condvar,
    /// Number of viewers of Foxglove's protocol.
    foxglove_viewers: AtomicUsize,
}

/// The shared state.
#[derive(Default)]
struct Shared {
    run: Option<Arc<RunLog>>,
    runs: u64,
    mode: Mode,
    /// The reason of a pause, or that of the outcome.
    reason: Option<String>,
    breakpoint: Option<String>,
    verdict: Option<String>,
    metrics: Option<Metrics>,
    breakpoints: Breaks,
    /// It grows with every change of the status.
    version: u64,
}

/// The breakpoints that the command line and the pages have set.
#[derive(Debug, Clone, Default)]
pub(super) struct Breaks {
    /// Their texts.
    pub(super) texts: Vec<String>,
    /// Those that the current policy has, as a page shows them.
    pub(super) infos: Vec<BreakpointInfo>,
    /// It grows with every change.
    pub(super) version: u64,
}

/// What the run does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Mode {
    #[default]
    Running,
    Paused,
    /// Paused after this number of ticks.
    Stepping(u32),
    Finished,
}

/// The pace of a run: the wall time of a simulated time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    /// Ratio of simulated time to wall time. `None` for no limit.
    speed: Option<f64>,
    /// A wall time and its simulated time (s).
    anchor: Option<(Instant, f64)>,
}

impl Pace {
    /// A pace with a ratio of simulated time to wall time. `None` for no limit.
    pub(super) fn new(speed: Option<f64>) -> Self {
        Self { speed, anchor: None }
    }

    /// The wall time at which a simulated time is due.
    fn due(&mut self, time: f64) -> Option<Instant> {
        let speed = self.speed?;
        let now = Instant::now();
        let (wall, start) = *self.anchor.get_or_insert((now, time));
        let due = Duration::try_from_secs_f64((time - start).max(0.0) / speed).ok().map(|after| wall + after)?;
        if due + LATE < now {
            self.anchor = Some((now, time));
        }
        Some(due)
    }
}

impl Hub {
    fn shared(&self) -> MutexGuard<'_, Shared> {
        // No thread panics between two changes that belong together.
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The number of the next run.
    pub(super) fn next_run(&self) -> u64 {
        self.shared().runs + 1
    }

    /// Begins a run.
    pub(super) fn begin(&self, run: Arc<RunLog>, is_paused: bool) {
        let mut shared = self.shared();
        shared.runs += 1;
        shared.run = Some(run);
        shared.mode = if is_paused { Mode::Paused } else { Mode::Running };
        (shared.breakpoint, shared.verdict, shared.metrics) = (None, None, None);
        shared.reason = is_paused.then(|| "start".to_owned());
        shared.version += 1;
        self.changed.notify_all();
    }

    /// The current run, with its number.
    pub(super) fn run(&self) -> Option<(u64, Arc<RunLog>)> {
        let shared = self.shared();
        shared.run.clone().map(|run| (shared.runs, run))
    }

    /// The status of the run with this number, if it is newer than `known`, with its version. `None` if there is another run.
    pub(super) fn status(&self, number: u64, known: Option<u64>) -> Option<(u64, Status)> {
        let shared = self.shared();
        if known == Some(shared.version) || shared.runs != number {
            return None;
        }
        let (version, run) = (shared.version, shared.run.clone()?);
        let mut status = Status {
            state: match shared.mode {
                Mode::Running | Mode::Stepping(_) => "running",
                Mode::Paused => "paused",
                Mode::Finished => "finished",
            },
            reason: shared.reason.clone(),
            breakpoint: shared.breakpoint.clone(),
            verdict: shared.verdict.clone(),
            metrics: shared.metrics,
            breakpoints: shared.breakpoints.infos.clone(),
            ..Status::default()
        };
        drop(shared);
        let past = run.past();
        (status.ticks, status.kept_every) = (past.len(), past.kept_every());
        drop(past);
        Some((version, status))
    }

    /// Changes what the run does, unless it has ended.
    fn change(&self, mode: Mode, reason: Option<&str>, breakpoint: Option<String>) {
        let mut shared = self.shared();
        if shared.mode != Mode::Finished {
            (shared.mode, shared.breakpoint) = (mode, breakpoint);
            shared.reason = reason.map(str::to_owned);
            shared.version += 1;
            self.changed.notify_all();
        }
    }

    /// Pauses the run for a page.
    pub(super) fn pause(&self) {
        self.change(Mode::Paused, Some("page"), None);
    }

    /// Pauses the run at a breakpoint.
    pub(super) fn pause_at(&self, breakpoint: String) {
        self.change(Mode::Paused, Some("breakpoint"), Some(breakpoint));
    }

    /// Continues the run.
    pub(super) fn resume(&self) {
        self.change(Mode::Running, None, None);
    }

    /// Executes some ticks of the run.
    pub(super) fn step(&self, ticks: u32) {
        self.change(Mode::Stepping(ticks.max(1)), None, None);
    }

    /// Ends the run with its outcome and the figures of its contour.
    pub(super) fn finish(&self, verdict: &str, reason: Option<String>, metrics: Metrics) {
        let mut shared = self.shared();
        shared.metrics = Some(metrics);
        (shared.mode, shared.breakpoint) = (Mode::Finished, None);
        (shared.verdict, shared.reason) = (Some(verdict.to_owned()), reason);
        shared.version += 1;
        self.changed.notify_all();
    }

    /// The breakpoints.
    pub(super) fn breakpoints(&self) -> Breaks {
        self.shared().breakpoints.clone()
    }

    /// The version of the breakpoints.
    pub(super) fn breakpoints_version(&self) -> u64 {
        self.shared().breakpoints.version
    }

    /// Replaces the breakpoints.
    pub(super) fn set_breakpoints(&self, texts: Vec<String>, infos: Vec<BreakpointInfo>) {
        let mut shared = self.shared();
        let version = shared.breakpoints.version + 1;
        shared.breakpoints = Breaks { texts, infos, version };
        shared.version += 1;
        self.changed.notify_all();
    }

    /// Waits after a tick until the next one may begin: until `time` (s) is due, and until no page has paused the run. Only a pause
    /// that a user asked for and the pace make the loop wait. `is_over` ends the wait and the run. The result is true if there was a
    /// pause.
    pub(super) fn wait(&self, pace: &mut Pace, time: f64, mut is_over: impl FnMut() -> bool) -> ControlFlow<(), bool> {
        let mut shared = self.shared();
        let mut has_paused = false;
        if let Mode::Stepping(ticks) = shared.mode {
            let is_last = ticks <= 1;
            shared.mode = if is_last { Mode::Paused } else { Mode::Stepping(ticks - 1) };
            if is_last {
                shared.reason = Some("page".to_owned());
                shared.version += 1;
            }
        }
        loop {
            let rest = match shared.mode {
                Mode::Running => match pace.due(time).and_then(|due| due.checked_duration_since(Instant::now())) {
                    Some(rest) if !rest.is_zero() => rest.min(LOOK),
                    _ => return ControlFlow::Continue(has_paused),
                },
                Mode::Paused => {
                    (pace.anchor, has_paused) = (None, true);
                    LOOK
                }
                Mode::Stepping(_) | Mode::Finished => return ControlFlow::Continue(has_paused),
            };
            shared =
                self.changed.wait_timeout(shared, rest).map_or_else(|broken| broken.into_inner().0, |(guard, _)| guard);
            if shared.mode == Mode::Paused && is_over() {
                return ControlFlow::Break(());
            }
        }
    }

    /// True if a viewer of Foxglove's protocol is connected.
    pub(super) fn has_foxglove_viewers(&self) -> bool {
        self.foxglove_viewers.load(Ordering::Relaxed) > 0
    }

    /// Notes a viewer of Foxglove's protocol, or the end of one.
    pub(super) fn foxglove_viewer(&self, is_new: bool) {
        if is_new {
            self.foxglove_viewers.fetch_add(1, Ordering::Relaxed);
        } else {
            self.foxglove_viewers.fetch_sub(1, Ordering::Relaxed);
        }
    }
}
