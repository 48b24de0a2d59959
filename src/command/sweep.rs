//! `vibrissa sweep`

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::{Args, ValueEnum};

use super::exit::Exit;
use super::experiment::{Experiment, FinishedRun};
use super::failure::Failure;
use super::options::{ArrayOptions, Format, Jobs, PruneOption};
use super::output;
use super::provenance::of_trials;
use super::report_folder::{say, written};
use super::trials::make_directory;
use vibrissa_lab::report::{summary_table, sweep_page};
use vibrissa_lab::results::{Provenance, SeedRange, add_seeds};
use vibrissa_lab::sweep::{
    Plan, ReadLine, Results, ScenesOf, Shard, Sweep, SweepLine, SweepSummary, read_line, run_rows,
};
use vibrissa_lab::trial::{Answer, StartError, Worker, answer};
use vibrissa_text::file::{CommandFiles, Output};

const EXAMPLE: &str = "Example:\n  vibrissa sweep sweeps/corners.yaml --out out/corners\n\nExit status: 0 every run has a result, whatever it is; 1 a run crashed or could not begin; 2 unusable input; 3 internal error; 130 interrupted.";

/// The folder of pictures in the directory of the results.
const PICTURES: &str = "runs";
/// The name of the page.
pub(super) const PAGE: &str = "index.html";
/// Number of runs of a group on the page. It keeps the page of a large sweep small.
const RUNS_SHOWN: usize = 200;

/// The runs of a sweep whose pictures are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Pictures {
    /// No run
    None,
    /// Each run that did not pass
    #[default]
    Failed,
    /// Every run. A picture has some hundred thousand bytes
    All,
}

impl Pictures {
    fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Failed => "failed",
            Self::All => "all",
        }
    }
}

/// The arguments of `vibrissa sweep`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct SweepArguments {
    /// Sweep file: scenes, policies and the parameters to vary
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    prune: PruneOption,
    #[command(flatten)]
    array: ArrayOptions,
    /// Run only the K-th of N parts. The part of a run depends only on its key
    #[arg(long, value_name = "K/N", default_value_t = Shard::WHOLE)]
    shard: Shard,
    #[command(flatten)]
    jobs: Jobs,
    /// Directory of the results and of a page with heat maps. The default is out/NAME. Runs whose results are already in it are skipped
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// The runs whose pictures are written into the folder `runs` of the directory. The page opens them
    #[arg(long, value_enum, default_value_t)]
    pictures: Pictures,
    #[command(flatten)]
    format: Format,
}

pub(super) fn sweep(arguments: &SweepArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let mismatch = arguments.array.load(&mut files)?;
    let plan = Plan::read(&arguments.file, !arguments.prune.no_prune, mismatch, &mut files)?;
    plan.analysed_policies(&mut files)?.iter().for_each(output::warnings);
    plan.check(output::message)?;
    let sweep = &plan.sweep;
    let directory = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(&sweep.name));
    make_directory(Some(&directory))?;
    let pictures = directory.join(PICTURES);
    if arguments.pictures != Pictures::None {
        make_directory(Some(&pictures))?;
    }
    let path = directory.join(arguments.shard.file_name());
    files.growing("--out", &path)?;
    let page = files.output("--out", &directory.join(PAGE))?;
    let provenance = of_sweep(&plan)?;
    let header = plan.header(arguments.shard);
    let (results, done) = Results::of_sweep(&path, &header, &provenance, sweep)?;
    let runs = sweep.runs().filter(|run| arguments.shard.has(&run.key()));
    let left: Vec<u64> = runs.map(|run| run.index).filter(|index| !done.contains_key(index)).collect();
    let mut experiment = Experiment::new(done.len() + left.len(), done, Some((path.clone(), results)));
    let fingerprint = header.fingerprint();
    let start = || worker(arguments, &pictures, &fingerprint);
    let mut calibrations = BTreeSet::new();
    experiment.run(
        &left,
        arguments.jobs,
        || None,
        |slot, index| answer(slot, start, &index.to_string()),
        |&index, answer| {
            let line = line(sweep, index, answer)?;
            let read = read_line(&line).map_err(Failure::Answer)?;
            let result = read.figures();
            calibrations.extend(read.calibration);
            Ok(Some(FinishedRun { key: index, result, line, shown: read.key }))
        },
    )?;
    output::calibrations(calibrations.iter());
    let resumed = experiment.resumed;
    let summary = SweepSummary::new(sweep, &experiment.finish(), resumed);
    print_summary(&provenance, &summary, &path, arguments.format)?;
    // The page of a part would show a part of the sweep. `merge` writes that of the whole.
    if arguments.shard == Shard::WHOLE {
        write_page(page, &provenance, sweep, &summary, &path, arguments.format)?;
    }
    Ok(if summary.without_result() == 0 { Exit::Done } else { Exit::Unexpected })
}

/// The origin of the results of a sweep.
fn of_sweep(plan: &Plan) -> Result<Provenance, Failure> {
    let samples: Vec<_> = plan.sweep.samples().collect();
    let trials = samples.iter().map(|run| plan.trial(run)).collect::<Result<Vec<_>, _>>()?;
    let mut provenance = of_trials(&trials);
    (provenance.scenes, provenance.seeds) = (Vec::new(), Vec::new());
    // The header of the results has the hashes of the files. Every run has those of its scene.
    provenance.hashes.scenarios.clear();
    for (run, trial) in samples.iter().zip(&trials) {
        let (scenes, first) = (run.scenes(), trial.seed.wrapping_sub(run.trial));
        let last = scenes.trials.saturating_sub(1);
        let seeds = match scenes.of {
            ScenesOf::Family(_) => SeedRange { first: scenes.family_seed(), last: scenes.family_seed() },
            ScenesOf::Scenario(_) => SeedRange { first, last: first.saturating_add(last) },
        };
        provenance.add_scene(&format!("{}, trials 0 to {last}", scenes.name()));
        add_seeds(&mut provenance.seeds, seeds);
    }
    for mismatch in &mut provenance.mismatches {
        let most = plan.sweep.scenes.iter().map(|scenes| scenes.trials).max().unwrap_or(1);
        if let Some(seeds) = mismatch.seeds.first_mut() {
            seeds.last = seeds.first.saturating_add(most.saturating_sub(1));
        }
    }
    Ok(provenance)
}

/// A process for runs: another instance of this program. A crash ends only one run.
fn worker(arguments: &SweepArguments, pictures: &Path, fingerprint: &str) -> Result<Worker, StartError> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("worker").arg(&arguments.file);
    if arguments.prune.no_prune {
        command.arg("--no-prune");
    }
    command.args(arguments.array.arguments());
    if arguments.pictures != Pictures::None {
        command.arg("--folder").arg(pictures).arg("--pictures").arg(arguments.pictures.name());
    }
    Worker::start(&mut command, fingerprint)
}

/// The line of the run with this index.
fn line(sweep: &Sweep, index: u64, answer: Result<Answer, StartError>) -> Result<String, Failure> {
    Ok(match (answer?, sweep.run(index)) {
        (Answer::Crash(reason), Some(run)) => {
            output::message(format_args!("{}: crashed: {reason}", run.key()));
            output::json_line(None, &SweepLine::crashed(&run, reason))?
        }
        (Answer::Line(line) | Answer::Crash(line), _) => line,
    })
}

/// Prints the summary of the runs whose results are at `path`.
pub(super) fn print_summary(
    provenance: &Provenance,
    summary: &SweepSummary,
    path: &Path,
    format: Format,
) -> Result<(), Failure> {
    output::document(format, provenance, summary, || [summary_table(&summary.groups)])?;
    if format.json {
        return Ok(());
    }
    output::result(format_args!("results: {}", PathBuf::from(path).display()))
}

/// Writes the page of a sweep whose results are at `path`.
pub(super) fn write_page(
    page: Output,
    provenance: &Provenance,
    sweep: &Sweep,
    summary: &SweepSummary,
    path: &Path,
    format: Format,
) -> Result<(), Failure> {
    let rows = run_rows(sweep, path, RUNS_SHOWN)?;
    let picture = |row: &ReadLine| {
        let name = format!("{PICTURES}/{}.svg", row.run);
        path.with_file_name(&name).is_file().then_some(name)
    };
    say(Some(written(page, sweep_page(provenance, summary, &rows, picture))?), format)
}
