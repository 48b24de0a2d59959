//! `vibrissa bench`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use sha2::{Digest, Sha256};

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, ConditionOptions, Format, Jobs, Policies, WorldOptions};
use super::output;
use super::provenance::of_runs;
use super::report_folder::{ReportFolder, say};
use super::trial_runs::run_all;
use super::trials::{Finished, report_dead_whiskers};
use super::values::parse_seed;
use vibrissa_lab::built_in::SCENARIOS;
use vibrissa_lab::load::{self, GivenMismatch, LoadError, Loaded, check_noise_seed};
use vibrissa_lab::report::{RunFigures, bench_page, bench_table, pooled_tips};
use vibrissa_lab::results::{Document, Ending, RunResult};
use vibrissa_lab::study::bench::{BenchRow, Conditions};
use vibrissa_lab::study::compare::OlderRuns;
use vibrissa_lab::trial::Trial;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa bench --out out\n  vibrissa bench --policy mine.fsm --friction 0,0.1\n\nExit status: 0 all runs completed and no figure is worse than that of the baseline; 1 otherwise; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa bench`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct BenchArguments {
    #[command(flatten)]
    trials: BenchTrials,
    /// Write all results, a picture of every run and a page that shows them into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Older report: its directory, or its `results.json`. The page of `--out` says what has changed since then
    #[arg(long, value_name = "DIR", requires = "out")]
    against: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

/// The trials of the bench.
#[derive(Debug, Args)]
pub(super) struct BenchTrials {
    #[command(flatten)]
    policies: Policies,
    #[command(flatten)]
    conditions: ConditionOptions,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    /// Seed of the noise of sensors and poses. Overrides the seeds of the scenes. Refused if no run has noise
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_seed)]
    seed: Option<u64>,
}

pub(super) fn bench(arguments: &BenchArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (trials, array) = bench_trials(&arguments.trials, &mut files)?;
    let older = arguments.against.as_deref().map(|path| older_runs(path, &mut files)).transpose()?;
    let pictures: Vec<String> = trials.iter().map(picture_name).collect();
    let names = pictures.iter().cloned().chain([RESULTS.to_owned()]);
    let report = ReportFolder::new("bench", arguments.out.as_deref(), names, &mut files)?;
    let (conditions, trials): (Vec<_>, Vec<_>) = trials.into_iter().unzip();
    let finished = run_all(&trials, &array, arguments.jobs, report.as_ref(), |_| arguments.out.is_some())?;
    let (mut rows, mut figures) = (Vec::with_capacity(finished.len()), Vec::new());
    for (Finished { result, figures: drawn, .. }, conditions) in finished.into_iter().zip(conditions) {
        let row = BenchRow::new(result).under(conditions);
        report_row(&row);
        rows.push(row);
        figures.push(drawn.unwrap_or_else(RunFigures::none));
    }
    let provenance = of_runs(rows.iter().map(|row| &row.result));
    let write = |mut report: ReportFolder| {
        for (name, figures) in pictures.iter().zip(&figures) {
            report.write(name, &figures.picture)?;
        }
        let documents = rows.iter().map(|row| serde_json::to_value(row.versioned(None)));
        let documents = documents.collect::<Result<Vec<_>, _>>()?;
        let changes = older.map(|older| older.changes(&documents));
        report.write(RESULTS, output::list(&provenance, &rows)? + "\n")?;
        report.finish(bench_page(&provenance, &rows, &figures, changes.as_ref()))
    };
    let page = report.map(write).transpose()?;
    output::documents(arguments.format, &provenance, &rows, || [bench_table(&rows)])?;
    if !arguments.format.json {
        output::result(pooled_tips(&rows))?;
    }
    say(page, arguments.format)?;
    Ok(if rows.iter().all(|row| row.passed) { Exit::Done } else { Exit::Unexpected })
}

/// The name of the file of all results.
const RESULTS: &str = "results.json";

/// Largest size of an older report in bytes. That of the bench has some hundred thousand.
const REPORT_LIMIT: usize = 1 << 28;

/// The runs of an older report: of a directory, or of a file of results.
fn older_runs(path: &Path, files: &mut CommandFiles) -> Result<OlderRuns, Failure> {
    let path = if path.is_dir() { path.join(RESULTS) } else { path.to_owned() };
    let bytes = files.read(&path, REPORT_LIMIT).map_err(LoadError::read(&path))?;
    let read = OlderRuns::read(path.display().to_string(), &String::from_utf8_lossy(&bytes));
    read.map_err(|cause| Failure::Older { path, cause })
}

/// The trials of every scenario under every policy and all conditions, and their array, which is not yet calibrated. The runs of a scenario are consecutive.
pub(super) fn bench_trials(
    arguments: &BenchTrials,
    files: &mut CommandFiles,
) -> Result<(Vec<(Conditions, Trial)>, GivenMismatch), Failure> {
    let policies = arguments.policies.load(files)?;
    let (conditions, mismatch) = arguments.conditions.of(arguments.array.load(files)?)?;
    let scenarios = SCENARIOS.iter().map(|file| Ok((file, load::built_in_scenario(file)?)));
    let scenarios = scenarios.collect::<Result<Vec<_>, Failure>>()?;
    let mut trials = Vec::with_capacity(scenarios.len() * policies.len() * conditions.len());
    for (file, scenario) in &scenarios {
        for policy in &policies {
            for &conditions in &conditions {
                let mut scene = scenario.value.clone();
                conditions.apply(&mut scene);
                let mut scenario_hash = Sha256::new_with_prefix(file.text);
                if !conditions.are_ideal() {
                    scenario_hash.update(format!("\0{conditions}"));
                }
                let path = Path::new(file.path);
                let (world, scene) = (arguments.world.of(&scene), Loaded { value: scene, hash: scenario_hash });
                let program = Arc::new(policy.value.artifact.program.clone());
                let trial = mismatch.trial((path, scene), (&program, policy.hash.clone()), world, 0)?;
                let seed = arguments.seed.unwrap_or(trial.seed);
                trials.push((conditions, Trial { seed, ..trial }));
            }
        }
    }
    let scenes = || trials.iter().map(|(_, trial)| &trial.scene);
    mismatch.check_effect(scenes()).map_err(LoadError::from)?;
    check_noise_seed(arguments.seed, scenes()).map_err(LoadError::from)?;
    Ok((trials, mismatch))
}

/// Reports the reason of a run that did not complete, what stopped it or the expectations that do not hold, and dead whiskers.
fn report_row(row: &BenchRow) {
    let RunResult { policy, outcome, .. } = &row.result;
    if *outcome != Ending::Completed {
        let explanation = row.result.explanation();
        let reason = explanation.as_deref().unwrap_or("unknown reason");
        output::message(format_args!("{}, {policy}: {outcome}: {reason}", row.scene()));
    }
    report_dead_whiskers(&format!("{}, {policy}", row.scene()), &row.result);
}

/// The name of the picture of a trial.
fn picture_name((conditions, trial): &(Conditions, Trial)) -> String {
    let scene = conditions.named(&trial.scene.name).replace(", ", "-").replace(' ', "-");
    format!("{scene}-{}.svg", trial.program.name)
}
