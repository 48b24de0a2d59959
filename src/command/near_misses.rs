//! `vibrissa inspect near-misses`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use sha2::Digest;

use super::exit::Exit;
use super::failure::Failure;
use super::inspect::breakpoints;
use super::options::{ArrayOptions, Format, Jobs, Settings, WorldOptions};
use super::output;
use super::progress::Progress;
use super::provenance::of_trials;
use super::trials::{calibrate, drawn, make_directory, say_calibrations};
use vibrissa_lab::built_in::SCENARIOS;
use vibrissa_lab::inspect::{Breakpoints, NearMiss, NearMisses};
use vibrissa_lab::load::{self, LoadError, Loaded};
use vibrissa_lab::report::near_miss_table;
use vibrissa_lab::sweep::Plan;
use vibrissa_lab::trial::{ExecuteError, Trial, in_parallel};
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::{CommandFiles, Output};

const EXAMPLE: &str = "Examples:\n  vibrissa inspect near-misses --policy mine.fsm --out out\n  vibrissa inspect near-misses --sweep sweeps/corners.yaml\n\nExit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa inspect near-misses`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct NearMissArguments {
    /// Scenarios or names of built-in ones. Without any, those of the bench
    #[arg(value_name = "SCENARIO", conflicts_with = "sweep")]
    scenarios: Vec<PathBuf>,
    /// Run all runs of this sweep instead, under its own policies
    #[arg(long, value_name = "FILE", conflicts_with_all = ["policy", "settings", "world"])]
    sweep: Option<PathBuf>,
    /// Policy. The default is that of each scenario, or `vibrissa.fsm`
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    /// Write the list, and a picture of every run in it, into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of near misses of each policy that are printed, the closest ones
    #[arg(long, value_name = "N", default_value_t = 20)]
    count: usize,
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

/// The runs of a policy.
struct PolicyRuns {
    policy: Breakpoints,
    /// Each trial with its name. The trials have the program that can be explained.
    trials: Vec<(String, Trial)>,
}

pub(super) fn near_misses(arguments: &NearMissArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let all = match &arguments.sweep {
        Some(path) => of_sweep(path, arguments, &mut files)?,
        None => of_scenarios(arguments, &mut files)?,
    };
    make_directory(arguments.out.as_deref())?;
    let mut listed = Vec::new();
    let mut progress = Progress::new(all.iter().map(|runs| runs.trials.len()).sum());
    for runs in &all {
        let mut misses = runs.run(arguments.jobs, &mut progress)?;
        misses.truncate(arguments.count);
        if let Some(directory) = &arguments.out {
            runs.draw(&misses, directory, &mut files)?;
        }
        listed.extend(misses);
    }
    progress.finish();
    let provenance = of_trials(trials(&all));
    if let Some(directory) = &arguments.out {
        let file = files.output("--out", &directory.join("near-misses.json"))?;
        file.write(output::list(&provenance, &listed)?)?;
    }
    output::documents(arguments.format, &provenance, &listed, || [near_miss_table(&listed)])?;
    Ok(Exit::Done)
}

impl PolicyRuns {
    /// Runs all trials. The result is the near misses of all of them together, the closest first.
    fn run(&self, jobs: Jobs, progress: &mut Progress) -> Result<Vec<NearMiss>, Failure> {
        let numbered: Vec<(usize, &(String, Trial))> = self.trials.iter().enumerate().collect();
        let run = |(number, (name, trial)): &(usize, &(String, Trial))| {
            let mut misses = NearMisses::new(&self.policy, *number, name);
            trial.run_watched(&mut misses)?;
            misses.end_run();
            Ok::<_, ExecuteError>((*number, misses))
        };
        let done = |result: &Result<(usize, NearMisses<'_>), ExecuteError>| {
            if let Some((name, _)) = result.as_ref().ok().and_then(|(number, _)| self.trials.get(*number)) {
                progress.done(name);
            }
        };
        let mut together: Option<NearMisses<'_>> = None;
        for (result, (_, trial)) in in_parallel(&numbered, jobs.threads(), run, done).into_iter().zip(&self.trials) {
            let (_, misses) = result.map_err(Failure::execute(trial))?;
            match &mut together {
                Some(together) => together.add(misses),
                None => together = Some(misses),
            }
        }
        Ok(together.map(|misses| misses.list()).unwrap_or_default())
    }

    /// Draws every run that has one of the near misses.
    fn draw(&self, misses: &[NearMiss], directory: &Path, files: &mut CommandFiles) -> Result<(), Failure> {
        let mut numbers: Vec<usize> = misses.iter().map(|miss| miss.run).collect();
        numbers.sort_unstable();
        numbers.dedup();
        for number in numbers {
            let Some((name, trial)) = self.trials.get(number) else { continue };
            let name = format!("{}-{name}.svg", self.policy.explained.program.name);
            let file: Output = files.output("--out", &directory.join(name))?;
            let result = trial.run().map_err(Failure::execute(trial))?;
            file.write(drawn(trial, &result).picture)?;
        }
        Ok(())
    }
}

/// The runs of the bench or of scenarios, by policy: the requested one, or the one of each scenario.
fn of_scenarios(arguments: &NearMissArguments, files: &mut CommandFiles) -> Result<Vec<PolicyRuns>, Failure> {
    let mismatch = arguments.array.load(files)?;
    let mut all: Vec<(Vec<u8>, PolicyRuns)> = Vec::new();
    for source in sources(&arguments.scenarios, files)? {
        let path = PathBuf::from(&source.name);
        let scene = load::scenario_in(&source, files)?;
        let policy = load::policy_for(arguments.policy.as_deref(), &scene.value, &source, files)?;
        let Loaded { value: policy, hash } = arguments.settings.of(policy)?;
        let finished = hash.clone().finalize();
        let index = if let Some(index) = all.iter().position(|(of, _)| **of == *finished) {
            index
        } else {
            output::warnings(&policy);
            let text = policy.text.as_ref().map(|text| &text.source);
            let explained = explained(text, &policy.artifact.program.name)?;
            all.push((finished.to_vec(), PolicyRuns { policy: explained, trials: Vec::new() }));
            all.len() - 1
        };
        let (_, runs) = &mut all[index];
        let program = Arc::new(runs.policy.explained.with_parameters_of(&policy.artifact.program));
        let (world, name) = (arguments.world.of(&scene.value), scene.value.name.clone());
        runs.trials.push((name, mismatch.trial((&path, scene), (&program, hash), world, 0)?));
    }
    let mut all: Vec<PolicyRuns> = all.into_iter().map(|(_, runs)| runs).collect();
    mismatch.check_effect(trials(&all).map(|trial| &trial.scene)).map_err(LoadError::from)?;
    for (_, trial) in all.iter_mut().flat_map(|runs| &mut runs.trials) {
        calibrate(trial, &mismatch)?;
    }
    say_calibrations(trials(&all));
    Ok(all)
}

/// The texts of scenarios. Without any, those of the bench.
fn sources(paths: &[PathBuf], files: &mut CommandFiles) -> Result<Vec<Source>, LoadError> {
    if paths.is_empty() {
        return Ok(SCENARIOS.iter().map(|file| Source::new(file.path, file.text)).collect());
    }
    paths.iter().map(|path| load::scenario_text(path, files)).collect()
}

/// The trials of all policies.
fn trials(all: &[PolicyRuns]) -> impl Iterator<Item = &Trial> {
    all.iter().flat_map(|runs| runs.trials.iter().map(|(_, trial)| trial))
}

/// The runs of a sweep, by policy.
fn of_sweep(path: &Path, arguments: &NearMissArguments, files: &mut CommandFiles) -> Result<Vec<PolicyRuns>, Failure> {
    let plan = Plan::read(path, true, arguments.array.load(files)?, files)?;
    plan.check(|note| output::message(format_args!("{note}")))?;
    let mut all = Vec::new();
    for (index, loaded) in plan.analysed_policies(files)?.into_iter().enumerate() {
        let source = loaded.text.as_ref().map(|text| &text.source);
        let policy = explained(source, &loaded.artifact.program.name)?;
        let mut trials = Vec::new();
        let runs: Vec<_> = plan.sweep.runs().filter(|run| run.policy == index).collect();
        let of_runs = in_parallel(&runs, arguments.jobs.threads(), |run| plan.trial(run), |_| ());
        for (run, trial) in runs.iter().zip(of_runs) {
            let trial = trial?;
            let program = Arc::new(policy.explained.with_parameters_of(&trial.program));
            trials.push((file_name(&run.key()), Trial { program, ..trial }));
        }
        say_calibrations(trials.iter().map(|(_, trial)| trial));
        all.push(PolicyRuns { policy, trials });
    }
    Ok(all)
}

/// A policy that can be explained. A compiled machine has no text.
fn explained(source: Option<&Source>, name: &str) -> Result<Breakpoints, Failure> {
    breakpoints(source.ok_or_else(|| Failure::NoTextToInspect { name: name.to_owned() })?, &[])
}

/// The key of a run as a part of a file's name.
fn file_name(key: &str) -> String {
    key.chars()
        .map(|letter| if letter.is_ascii_alphanumeric() || "-.".contains(letter) { letter } else { '_' })
        .collect()
}
