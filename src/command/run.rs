//! `vibrissa run`

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Args;
#[cfg(feature = "recording")]
use vibrissa_runtime::machine::Artifact;

use super::exit::Exit;
use super::failure::Failure;
use super::inspect::{InspectionOptions, inspect};
#[cfg(feature = "live")]
use super::live::LivePage;
use super::options::{ArrayOptions, Format, Settings, WorldOptions};
use super::output;
use super::provenance::of_trials;
use super::reports::Reports;
use super::run_outputs::RunOutputs;
#[cfg(any(feature = "render", feature = "viewer"))]
use super::run_outputs::VideoOptions;
use super::trials::{calibrate, say_calibrations};
use super::values::parse_seed;
use super::watch::watch;
use vibrissa_lab::load::{GivenMismatch, LoadError, check_noise_seed};
use vibrissa_lab::request::{Input, PolicyInput, TrialRequest};
use vibrissa_lab::results::{Provenance, tick_lines};
use vibrissa_lab::run::Run;
use vibrissa_lab::trial::Trial;
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::{CommandFiles, Output};

const EXAMPLE: &str = "Example:\n  vibrissa run scenarios/disk.yaml --out out\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa run`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct RunArguments {
    /// Scenario files or names of built-in scenarios such as `disk`, one run each
    #[arg(value_name = "SCENARIO", required = true)]
    pub(super) scenarios: Vec<PathBuf>,
    /// Policy, compiled machine or name of a built-in policy such as `thesis`. Overrides the policy that the scenario names. If it names
    /// none, `vibrissa.fsm` is used
    #[arg(long, value_name = "FILE")]
    pub(super) policy: Option<PathBuf>,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    /// Seed of the sensor noise. Overrides the seed of the scenario. Refused if no run has noise
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_seed)]
    seed: Option<u64>,
    /// Write pictures and the result of every run into this directory, and a page that shows all runs
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Write the perception and the command of every tick into this file, as one line of JSON each
    #[arg(long, value_name = "FILE", conflicts_with = "watch")]
    ticks: Option<PathBuf>,
    /// Record the run into this MCAP file, for viewers and for `vibrissa replay`. With one scenario
    #[cfg(feature = "recording")]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["watch", "transitions"])]
    pub(super) record: Option<PathBuf>,
    #[cfg(any(feature = "render", feature = "viewer"))]
    #[command(flatten)]
    pub(super) video: VideoOptions,
    #[command(flatten)]
    pub(super) inspection: InspectionOptions,
    #[cfg(feature = "live")]
    #[command(flatten)]
    pub(super) live: LivePage,
    #[command(flatten)]
    pub(super) format: Format,
    /// Run again whenever a scenario or policy is saved, and print a line for every simulated second
    #[arg(long, conflicts_with = "json")]
    watch: bool,
}

pub(super) fn run(arguments: &RunArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    #[cfg(feature = "live")]
    let is_live = arguments.live.is_asked_for();
    #[cfg(not(feature = "live"))]
    let is_live = false;
    if arguments.watch {
        if !arguments.inspection.breakpoints.is_empty() && !is_live {
            return Err(Failure::BreakWatch);
        }
        return watch(arguments);
    }
    if arguments.inspection.is_given() && !is_live {
        if let Some(argument) = RunOutputs::first_given(arguments) {
            return Err(Failure::BreakOutput { argument });
        }
        return inspect(arguments, &mut files);
    }
    let prepared = prepared_trials(arguments, &mut files)?;
    let trials = prepared.iter().map(|prepared| &prepared.trial);
    let mut reports = Reports::new(trials, arguments.out.as_deref(), &mut files)?;
    let provenance = of_trials(prepared.iter().map(|prepared| &prepared.trial));
    let mut ticks = TickFile::new(arguments, &mut files)?;
    let mut outputs = RunOutputs::new(arguments, &prepared, &mut files)?;
    let (mut exit, mut written) = (Exit::Done, Ok(()));
    for (index, prepared) in prepared.iter().enumerate() {
        let trial = &prepared.trial;
        let (finished, of_run) = outputs.run(prepared)?;
        // Every output that failed is told, the last one at the end of the command.
        if let Err(failure) = of_run
            && let Err(before) = std::mem::replace(&mut written, Err(failure))
        {
            before.report();
        }
        reports.add(&provenance, index, trial, &finished)?;
        if !finished.violations.is_empty() {
            exit = Exit::Unexpected;
        }
        ticks.add(&provenance, trial, &finished.run)?;
    }
    ticks.write()?;
    reports.show(&provenance, arguments.format)?;
    outputs.serve_on();
    written.map(|()| exit)
}

/// A trial with the policy that it was made from.
pub(super) struct Prepared {
    pub(super) trial: Trial,
    /// The text of the policy. A compiled machine has none.
    pub(super) text: Option<Source>,
    /// The machine. Its parameters are those of its text.
    #[cfg(feature = "recording")]
    pub(super) artifact: Artifact,
}

/// The file of `--ticks`, if it is wanted.
pub(super) struct TickFile {
    file: Option<Output>,
    lines: String,
}

impl TickFile {
    pub(super) fn new(arguments: &RunArguments, files: &mut CommandFiles) -> Result<Self, Failure> {
        let file = arguments.ticks.as_ref().map(|path| files.output("--ticks", path)).transpose()?;
        Ok(Self { file, lines: String::new() })
    }

    /// Adds the ticks of a run.
    pub(super) fn add(&mut self, provenance: &Provenance, trial: &Trial, run: &Run) -> Result<(), Failure> {
        if self.file.is_some() {
            for line in tick_lines(&trial.scene.name, &run.trace, trial.assumed_rig.sensing.friction) {
                self.lines += &output::json_line(self.lines.is_empty().then_some(provenance), &line)?;
            }
        }
        Ok(())
    }

    pub(super) fn write(self) -> Result<(), Failure> {
        Ok(self.file.map_or(Ok(()), |file| file.write(self.lines))?)
    }
}

/// The trials of a command line, each with its policy. The warnings of each policy are printed once. An error in the last scenario shows
/// before the first trial runs.
pub(super) fn prepared_trials(arguments: &RunArguments, files: &mut CommandFiles) -> Result<Vec<Prepared>, Failure> {
    let mut warned = BTreeSet::new();
    let mismatch = arguments.array.load(files)?;
    let trials = arguments.scenarios.iter().map(|path| trial(path, arguments, &mismatch, files, &mut warned));
    let mut trials = trials.collect::<Result<Vec<_>, _>>()?;
    // Reports are named after scenarios.
    for (index, Prepared { trial, .. }) in trials.iter().enumerate() {
        let mut before = trials[..index].iter().map(|before| &before.trial);
        if let Some(first) = before.find(|first| first.scene.name == trial.scene.name) {
            let [first, second] = [first, trial].map(|trial| trial.inputs.scenario.clone());
            return Err(Failure::SameName { first, second, name: trial.scene.name.clone() });
        }
    }
    mismatch.check_effect(trials.iter().map(|prepared| &prepared.trial.scene)).map_err(LoadError::from)?;
    check_noise_seed(arguments.seed, trials.iter().map(|prepared| &prepared.trial.scene)).map_err(LoadError::from)?;
    for Prepared { trial, .. } in &mut trials {
        calibrate(trial, &mismatch)?;
    }
    say_calibrations(trials.iter().map(|prepared| &prepared.trial));
    Ok(trials)
}

fn trial(
    path: &Path,
    arguments: &RunArguments,
    mismatch: &GivenMismatch,
    files: &mut CommandFiles,
    warned: &mut BTreeSet<String>,
) -> Result<Prepared, Failure> {
    let WorldOptions { world, prune } = &arguments.world;
    let request = TrialRequest {
        policy: arguments.policy.clone().map(PolicyInput::File),
        settings: arguments.settings.pairs().to_vec(),
        world: world.kind(),
        prune: !prune.no_prune,
        seed: arguments.seed,
        ..TrialRequest::new(Input::File(path.to_owned()))
    };
    // The warnings may explain why a parameter cannot be set.
    let (trial, policy) = request.prepare_in(mismatch, files, |policy| {
        if let Some(text) = &policy.text
            && warned.insert(text.source.name.clone())
        {
            output::warnings(policy);
        }
    })?;
    output::warn_of_rates(path, &trial.scene.rig, &policy.artifact.program);
    Ok(Prepared {
        trial,
        text: policy.text.map(|text| text.source),
        #[cfg(feature = "recording")]
        artifact: policy.artifact,
    })
}
