//! Trials of a command, their reports and their messages.

use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use vibrissa_runtime::machine::{Observer, TransitionId, TriedGuard, ViolatedContract};
use vibrissa_runtime::signal::Sample;

use super::failure::Failure;
use super::output;
use vibrissa_declare::figures::Metric;
use vibrissa_lab::load::GivenMismatch;
use vibrissa_lab::report::{RunFigures, retrieval_picture};
use vibrissa_lab::results::{
    Collisions, Document, Ending, Failsafes, Inclination, ObjectFriction, Provenance, RunResult, WhiskerResponse,
};
use vibrissa_lab::run::{Trace, Watcher};
use vibrissa_lab::trial::{Trial, TrialResult};
use vibrissa_text::diagnostic::printable;
use vibrissa_text::file::{CommandFiles, Output, OutputError};
use vibrissa_world::scene::Violation;
use vibrissa_world::world::World;

/// The kept part of a trial's result. A trace is large.
#[derive(Serialize, Deserialize)]
pub(super) struct Finished {
    pub(super) result: RunResult,
    /// The figures, if they were asked for.
    pub(super) figures: Option<RunFigures>,
}

/// The trial whose control knows the calibration of its array.
pub(super) fn calibrated(trial: &Trial, array: &GivenMismatch) -> Result<Trial, Failure> {
    let mut trial = trial.clone();
    calibrate(&mut trial, array)?;
    Ok(trial)
}

/// The same in place. A scene may be large.
pub(super) fn calibrate(trial: &mut Trial, array: &GivenMismatch) -> Result<(), Failure> {
    array.calibrate(trial).map_err(Failure::calibration(&trial.inputs.scenario))
}

/// Says which calibrations the arrays of trials have.
pub(super) fn say_calibrations<'t>(trials: impl Iterator<Item = &'t Trial>) {
    let calibrations: Vec<_> = trials.filter_map(Trial::calibration).collect();
    output::calibrations(calibrations.iter());
}

/// Runs one trial.
pub(super) fn finished(trial: &Trial, is_drawn: impl Fn(&[Violation]) -> bool) -> Result<Finished, Failure> {
    let result = trial.run().map_err(Failure::execute(trial))?;
    let figures = is_drawn(&result.violations).then(|| drawn(trial, &result));
    Ok(Finished { result: trial.document(&result), figures })
}

pub(super) fn drawn(trial: &Trial, result: &TrialResult) -> RunFigures {
    RunFigures::new(&trial.scene, &trial.policy_label(), &result.run, &result.score)
}

/// Runs a trial under a watcher, and shows a progress bar on standard error if that is a terminal.
pub(super) fn run_with_bar(trial: &Trial, watcher: &mut impl Watcher) -> Result<TrialResult, Failure> {
    let bar = ProgressBar::new(milliseconds(trial.scene.stop.time));
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {percent} % of at most {prefix}, {elapsed}") {
        bar.set_style(style);
    }
    bar.set_message(printable(&trial.scene.name).into_owned());
    bar.set_prefix(format!("{} s", trial.scene.stop.time));
    let result = run_each_second(trial, watcher, |trace| {
        bar.set_position(milliseconds(seconds(trace)));
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    result
}

/// Runs a trial under a watcher. `each_second` receives the trace after each simulated second, and may stop the run.
pub(super) fn run_each_second(
    trial: &Trial,
    watcher: &mut impl Watcher,
    each_second: impl FnMut(&Trace) -> ControlFlow<()>,
) -> Result<TrialResult, Failure> {
    let mut watcher = EachSecond { watcher, receive: each_second, next: 1.0 };
    trial.run_watched(&mut watcher).map_err(Failure::execute(trial))
}

/// A watcher, and a function that receives the trace after each simulated second.
struct EachSecond<'w, W, F> {
    watcher: &'w mut W,
    receive: F,
    next: f64,
}

impl<W: Watcher, F> Observer for EachSecond<'_, W, F> {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        self.watcher.guard(tried);
    }

    fn taken(&mut self, transition: TransitionId) {
        self.watcher.taken(transition);
    }

    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        self.watcher.violated(violated);
    }

    fn not_finite(&mut self, state: usize, registers: &[f64]) {
        self.watcher.not_finite(state, registers);
    }
}

impl<W: Watcher, F: FnMut(&Trace) -> ControlFlow<()>> Watcher for EachSecond<'_, W, F> {
    fn before_tick(&mut self, samples: &[Sample]) {
        self.watcher.before_tick(samples);
    }

    fn in_world(&mut self, trace: &Trace, world: &dyn World) {
        self.watcher.in_world(trace, world);
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        self.watcher.after_tick(trace)?;
        if seconds(trace) < self.next {
            return ControlFlow::Continue(());
        }
        self.next = seconds(trace).floor() + 1.0;
        (self.receive)(trace)
    }
}

/// The simulated time (s).
pub(super) fn seconds(trace: &Trace) -> f64 {
    trace.ticks.last().map_or(0.0, |tick| tick.time)
}

fn milliseconds(seconds: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive time, only to be shown")]
    let milliseconds = (seconds * 1e3) as u64;
    milliseconds
}

/// The files for the pictures and the result of a run.
pub(super) struct ReportFiles {
    picture: Output,
    /// The strips of its retrievals. Without any, a file of an earlier run is removed.
    retrievals: Output,
    result: Output,
}

impl ReportFiles {
    /// `stem` with their extensions, in the directory that `--out` gives.
    pub(super) fn new(stem: &Path, files: &mut CommandFiles) -> Result<Self, OutputError> {
        let mut file = |extension| files.output("--out", &extended(stem, extension));
        Ok(Self { picture: file("svg")?, retrievals: file("retrievals.svg")?, result: file("json")? })
    }

    /// Writes the pictures and the result, and returns the figures.
    pub(super) fn write(
        self,
        provenance: &Provenance,
        trial: &Trial,
        result: &TrialResult,
        document: &RunResult,
    ) -> Result<RunFigures, Failure> {
        let figures = drawn(trial, result);
        self.picture.write(&figures.picture)?;
        match retrieval_picture(&trial.scene, &trial.policy_label(), &result.run.trace) {
            Some(strips) => self.retrievals.write(strips)?,
            None => self.retrievals.remove()?,
        }
        self.result.write(serde_json::to_string_pretty(&document.versioned(Some(provenance)))? + "\n")?;
        Ok(figures)
    }
}

/// Makes the directory for reports.
pub(super) fn make_directory(directory: Option<&Path>) -> Result<(), Failure> {
    directory.map_or(Ok(()), |directory| std::fs::create_dir_all(directory).map_err(Failure::folder(directory)))
}

/// A path with an extension after its name. Names of scenarios may contain points.
pub(super) fn extended(stem: &Path, extension: &str) -> PathBuf {
    let mut path = stem.as_os_str().to_owned();
    path.push(".");
    path.push(extension);
    path.into()
}

/// Names the whiskers that seem dead or insensitive.
pub(super) fn report_dead_whiskers(scene: &str, result: &RunResult) {
    let friction = match result.friction {
        Some(ObjectFriction { coefficient, is_assumed: false }) => format!(
            "; a likely cause is the friction of {coefficient}, which perception does not assume: state it in \
             `rig.sensing.friction`"
        ),
        Some(ObjectFriction { coefficient, .. }) => {
            format!("; a likely cause is the friction of {coefficient}, with which tips stick")
        }
        None => String::new(),
    };
    for WhiskerResponse { whisker, bent_s, response, .. } in result.dead_whiskers() {
        let percent = 100.0 * response.unwrap_or(0.0);
        output::message(format_args!(
            "{scene}: warning: {whisker} seems dead or insensitive: it was bent for {bent_s:.1} s, and its perceived bend \
             changed by {percent:.0} % of the true one{friction}"
        ));
    }
}

/// Prints the expectations that a run did not meet. For a run that ended, the [events](report_events) have them.
pub(super) fn report_violations(scene: &str, result: &TrialResult) {
    if result.ending() != Ending::Ended {
        for violation in &result.violations {
            output::message(format_args!("{scene}: {violation}"));
        }
    }
}

/// Prints the notable events of a run.
pub(super) fn report_events(result: &RunResult) {
    let RunResult { scenario, outcome, collisions, inclination, out_of_plane, .. } = result;
    let figure = |metric| result.figure(metric).unwrap_or(f64::NAN);
    if let Some(explanation) = result.explanation() {
        output::message(format_args!("{scenario}: {outcome}: {explanation}"));
    }
    report_dead_whiskers(scenario, result);
    if result.collided() {
        let [count, time_s] = [Metric::Collisions, Metric::CollisionTime].map(figure);
        let Collisions { first_s, first_state, first_position_m, .. } = collisions;
        let [x, y] = first_position_m.unwrap_or([f64::NAN; 2]);
        let (first_s, state) = (first_s.unwrap_or(f64::NAN), first_state.as_deref().unwrap_or("no state"));
        let times = if count > 1.0 { format!("{count} times, first") } else { "once".to_owned() };
        output::message(format_args!(
            "{scenario}: the platform's body collided {times} at {first_s:.2} s in {state}, with its centre at ({x:.3} m, {y:.3} m); \
             {time_s:.1} s in contact"
        ));
    }
    // A planar simulation keeps every whisker in the plane.
    if let (Some(inclination), Some(_)) = (inclination, out_of_plane)
        && let Inclination { whisker: Some(whisker), time_s, state, .. } = inclination
        && let beyond_s = figure(Metric::InclinationBeyond)
        && beyond_s > 0.0
    {
        let state = state.as_deref().unwrap_or("no state");
        let excess = -figure(Metric::InclinationMargin).to_degrees();
        output::message(format_args!(
            "{scenario}: whiskers were beyond the limit of the inclination for {beyond_s:.1} s, at most by {excess:.0} deg: \
             {whisker} at {time_s:.2} s in {state}; a round whisker leaves the plane there"
        ));
    }
    if let Failsafes { count, first_s: Some(time), first_state: Some(state), first_cause: Some(cause) } =
        &result.failsafes
    {
        let times = if *count == 1 { "once".to_owned() } else { format!("{count} times") };
        output::message(format_args!(
            "{scenario}: the fallback transition was taken {times}, first at {time:.2} s in {state}: {cause}"
        ));
    }
}
