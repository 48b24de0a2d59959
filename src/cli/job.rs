//! A run, from its files to its report.

use crate::report::Document;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use sha2::Digest;

use crate::diagnostic::printable;
use crate::file::{CommandFiles, Output, OutputError};
use crate::report::{Failsafes, Hashes, Identity, RunResult, picture};
use crate::run::{Run, Trace};
use crate::scene::{Scene, WorldSetup};
use crate::score::Score;
use crate::study::{engine_hash, execute};
use vibrissa_runtime::machine::Program;

use super::arguments::RunArguments;
use super::exit::Failure;
use super::input::{self, Loaded, Policy, PolicyText};
use super::output;

/// A run that is ready to begin.
pub(super) struct Job {
    pub(super) path: PathBuf,
    pub(super) scene: Scene,
    pub(super) program: Arc<Program>,
    pub(super) world: WorldSetup,
    pub(super) seed: u64,
    /// Hashes of the scenario and of the policy with its parameters.
    hashes: [String; 2],
    /// What reading its files and compiling its policy took.
    preparation: Duration,
}

/// The names of the policies whose warnings have been told.
pub(super) type Told = BTreeSet<String>;

/// The places for the picture and the result of a run.
pub(super) struct ReportFiles {
    picture: Output,
    result: Output,
}

impl ReportFiles {
    /// `stem` with their extensions, in the directory that `--out` gives.
    pub(super) fn new(stem: &Path, files: &mut CommandFiles) -> Result<Self, OutputError> {
        let picture = files.output("--out", &extended(stem, "svg"))?;
        Ok(Self { picture, result: files.output("--out", &extended(stem, "json"))? })
    }
}

impl Job {
    /// Prepares all runs that a command line asks for. Whatever is wrong with the last scenario shows before the first has
    /// run.
    pub(super) fn all(
        arguments: &RunArguments,
        files: &mut CommandFiles,
        told: &mut Told,
    ) -> Result<Vec<Self>, Failure> {
        let jobs = arguments.scenarios.iter().map(|path| Self::new(path, arguments, files, told));
        let jobs = jobs.collect::<Result<Vec<_>, _>>()?;
        // Reports are named after scenarios, so that two of one name would overwrite each other.
        for (index, job) in jobs.iter().enumerate() {
            if let Some(first) = jobs[..index].iter().find(|first| first.scene.name == job.scene.name) {
                let name = job.scene.name.clone();
                return Err(Failure::SameName { first: first.path.clone(), second: job.path.clone(), name });
            }
        }
        Ok(jobs)
    }

    /// Prepares one run. Tells the warnings of its policy, unless that has been done.
    fn new(path: &Path, arguments: &RunArguments, files: &mut CommandFiles, told: &mut Told) -> Result<Self, Failure> {
        let before = Instant::now();
        let source = input::read(path, files)?;
        let scenario = input::scenario_in(&source, files)?;
        let scene = scenario.value;
        let policy = input::policy_for(arguments.policy.as_deref(), &scene, &source, files)?;
        if let Some(PolicyText { source, warnings, .. }) = &policy.value.text
            && told.insert(source.name.clone())
        {
            output::diagnostics(source, warnings);
        }
        let Loaded { value: Policy { artifact, .. }, hash: policy_hash } = arguments.settings.of(policy)?;
        let hashes = (scenario.hash.finalize(), policy_hash.finalize());
        let seed = arguments.seed.unwrap_or(scene.seed);
        let world = arguments.pruning.of(arguments.world, &scene);
        let job = Self::with(path, scene, artifact.program, world, seed, hashes);
        Ok(Self { preparation: before.elapsed(), ..job })
    }

    /// A run of `program` in a `scene` that was read from `path`, with the hashes of both.
    pub(super) fn with(
        path: &Path,
        scene: Scene,
        program: Program,
        world: WorldSetup,
        seed: u64,
        (scenario_hash, policy_hash): (impl AsRef<[u8]>, impl AsRef<[u8]>),
    ) -> Self {
        let hashes = [input::short(scenario_hash.as_ref()), input::short(policy_hash.as_ref())];
        let (path, program) = (path.to_owned(), Arc::new(program));
        Self { path, scene, program, world, seed, hashes, preparation: Duration::ZERO }
    }

    /// Runs it, and shows a bar on standard error if that is a terminal.
    pub(super) fn execute_with_bar(&self) -> Result<Run, Failure> {
        let bar = ProgressBar::new(milliseconds(self.scene.stop.time));
        if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {percent} % of at most {prefix}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(printable(&self.scene.name).into_owned());
        bar.set_prefix(format!("{} s", self.scene.stop.time));
        let run = self.execute(|trace| {
            bar.set_position(milliseconds(seconds(trace)));
            ControlFlow::Continue(())
        });
        bar.finish_and_clear();
        run
    }

    /// Runs it; `each_second` of simulated time it hears what has happened so far, and may break the run off.
    pub(super) fn execute(&self, mut each_second: impl FnMut(&Trace) -> ControlFlow<()>) -> Result<Run, Failure> {
        let mut next = 1.0;
        let progress = |trace: &Trace| {
            if seconds(trace) < next {
                return ControlFlow::Continue(());
            }
            next = seconds(trace).floor() + 1.0;
            each_second(trace)
        };
        let run = execute(&self.scene, Arc::clone(&self.program), self.world, self.seed, progress);
        let mut run = run.map_err(|cause| Failure::Execute { scenario: self.path.clone(), cause })?;
        run.start += self.preparation;
        Ok(run)
    }

    /// The result of its run.
    pub(super) fn result(&self, run: &Run, score: &Score) -> RunResult {
        RunResult::new(self.identity(), run, score)
    }

    /// What its result is called by. The engine's hash is that of the whole model, which no run has to wait for.
    fn identity(&self) -> Identity {
        let [scenario, policy] = self.hashes.clone();
        let engine = input::short(&engine_hash(&self.scene, self.world));
        Identity {
            scenario: self.scene.name.clone(),
            policy: self.program.name.clone(),
            world: self.world.kind.to_string(),
            seed: self.seed,
            hash: Hashes { scenario, policy, engine },
        }
    }

    /// Writes a picture and the result of its run.
    pub(super) fn write_report(
        &self,
        to: ReportFiles,
        run: &Run,
        score: &Score,
        result: &RunResult,
    ) -> Result<(), Failure> {
        to.picture.write(picture(&self.scene, &result.policy, run, score))?;
        to.result.write(serde_json::to_string_pretty(&result.versioned())? + "\n")?;
        Ok(())
    }
}

/// A path with an extension behind whatever it ends in: names of scenarios may have points.
pub(super) fn extended(stem: &Path, extension: &str) -> PathBuf {
    let mut path = stem.as_os_str().to_owned();
    path.push(".");
    path.push(extension);
    path.into()
}

/// How much time has been simulated (s).
pub(super) fn seconds(trace: &Trace) -> f64 {
    trace.ticks.last().map_or(0.0, |tick| tick.time)
}

fn milliseconds(seconds: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive time, only to be shown")]
    let milliseconds = (seconds * 1e3) as u64;
    milliseconds
}

/// Tells what is to be noticed about a run.
pub(super) fn tell(result: &RunResult) {
    let RunResult { scenario, outcome, reason, collisions, .. } = result;
    if let Some(reason) = reason {
        output::message(format_args!("{scenario}: {outcome}: {reason}"));
    }
    if collisions.count > 0 {
        let touched = collisions.time_s;
        output::message(format_args!("{scenario}: the platform's body touched something for {touched:.1} s"));
    }
    tell_failsafes(result);
}

/// Tells that states were left by their failsafe.
fn tell_failsafes(result: &RunResult) {
    let Failsafes { count, first_s: Some(time), first_state: Some(state), first_cause: Some(cause) } =
        &result.failsafes
    else {
        return;
    };
    let times = if *count == 1 { "once".to_owned() } else { format!("{count} times") };
    output::message(format_args!(
        "{}: the failsafe was taken {times}, first at {time:.2} s in {state}: {cause}",
        result.scenario
    ));
}
