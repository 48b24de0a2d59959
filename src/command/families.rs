//! `vibrissa families`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use sha2::{Digest, Sha256};
use vibrissa_declare::catalogue::common::SPEED;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::units::{Dimension, format_si};

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, FamilyValues, Format, Jobs, Settings, WorldOptions};
use super::output;
use super::provenance::of_runs;
use super::report_folder::{ReportFolder, say};
use super::trial_runs::run_all;
use super::trials::{Finished, report_dead_whiskers};
use super::values::{parse_runs, parse_seed};
use vibrissa_lab::built_in::DEFAULT_POLICY;
use vibrissa_lab::family::{Draw, FAMILIES, Family, FamilyRun, FamilyTally, SPEEDS};
use vibrissa_lab::load::{self, GivenMismatch, LoadError, Loaded, with_settings};
use vibrissa_lab::report::{families_page, families_table};
use vibrissa_lab::results::{Provenance, SeedRange};
use vibrissa_lab::trial::{Trial, in_parallel};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{Scene, Violation, WorldSetup};

const EXAMPLE: &str = "Example:\n  vibrissa families convex-corner --count 50 --out out\n\nExit status: 0 all runs passed; 1 otherwise; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa families`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct FamiliesArguments {
    /// Names of families to run, or scenarios with a section `draw`. The default is all built-in families except `shapes` and `rooms`, whose runs take long
    #[arg(value_name = "FAMILY")]
    families: Vec<PathBuf>,
    /// Policy, compiled machine or name of a built-in policy such as `thesis`, with a parameter `speed`. The default is `vibrissa.fsm`
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    values: FamilyValues,
    /// Number of scenes of each family, from 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = parse_runs)]
    count: u64,
    /// Seed of the scenes
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true, value_parser = parse_seed)]
    seed: u64,
    /// Run only the scene with this number
    #[arg(long, value_name = "K", conflicts_with = "count", allow_negative_numbers = true, value_parser = parse_seed)]
    trial: Option<u64>,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    /// Print the scenarios instead of running them
    #[arg(long, conflicts_with_all = ["json", "out", "policy", "settings"])]
    print: bool,
    /// Write all results, a picture of every run that did not pass, and a page with pass rates into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

/// The name of the file of all results.
const RESULTS: &str = "results.jsonl";

/// One of the scenes of a family.
struct Drawn {
    family: String,
    number: u64,
    draw: Draw,
}

pub(super) fn families(arguments: &FamiliesArguments) -> Result<Exit, Failure> {
    if arguments.settings.has("speed") {
        return Err(Failure::DrawnSpeed);
    }
    let mut files = CommandFiles::new();
    let families = chosen(&arguments.families, &mut files)?;
    let scenes = scenes(&families, arguments)?;
    if arguments.print {
        for scene in &scenes {
            print(scene, arguments.seed)?;
        }
        return Ok(Exit::Done);
    }
    let policy = match &arguments.policy {
        Some(path) => load::policy(path, &mut files)?,
        None => load::built_in_policy(&DEFAULT_POLICY)?,
    };
    output::warnings(&policy.value);
    let policy = arguments.settings.of(policy)?;
    let mismatch = arguments.array.load(&mut files)?;
    let program = (&policy.value.artifact.program, &policy.hash);
    let trial = |Drawn { draw, number, .. }: &Drawn| {
        drawn_trial(draw, program, &mismatch, |scene| arguments.world.of(scene), *number)
    };
    let trials = scenes.iter().map(trial).collect::<Result<Vec<_>, Failure>>()?;
    mismatch.check_effect(trials.iter().map(|trial| &trial.scene)).map_err(LoadError::from)?;
    let names: Vec<String> = scenes.iter().map(|scene| format!("{}.svg", scene.draw.scene.name)).collect();
    let all = names.iter().cloned().chain([RESULTS.to_owned()]);
    let report = ReportFolder::new("families", arguments.out.as_deref(), all, &mut files)?;
    let is_drawn = |violations: &[Violation]| arguments.out.is_some() && !violations.is_empty();
    let finished = run_all(&trials, &mismatch, arguments.jobs, report.as_ref(), is_drawn)?;
    let (runs, pictures) = with_verdicts(scenes, finished);
    let provenance = of_families(&runs, arguments);
    let tallies = tallies(&families, &runs);
    let write = |mut report: ReportFolder| {
        let links: Vec<_> =
            names.iter().zip(&pictures).map(|(name, drawn)| drawn.as_ref().map(|_| name.clone())).collect();
        for (name, picture) in names.iter().zip(pictures) {
            picture.map(|picture| report.write(name, picture)).transpose()?;
        }
        let mut lines = String::new();
        for run in &runs {
            lines += &output::json_line(lines.is_empty().then_some(&provenance), run)?;
        }
        report.write(RESULTS, lines)?;
        report.finish(families_page(&provenance, &tallies, &runs, &links))
    };
    let page = report.map(write).transpose()?;
    output::documents(arguments.format, &provenance, &runs, || [families_table(&tallies)])?;
    say(page, arguments.format)?;
    Ok(if runs.iter().all(|run| run.passed) { Exit::Done } else { Exit::Unexpected })
}

/// The origin of the results of families. Their scenes are drawn, so families stand for them.
fn of_families(runs: &[FamilyRun], arguments: &FamiliesArguments) -> Provenance {
    let mut provenance = of_runs(runs.iter().map(|run| &run.result));
    provenance.scenes.clear();
    provenance.hashes.scenarios.clear();
    let trials = match arguments.trial {
        Some(trial) => format!("trial {trial}"),
        None => format!("trials 0 to {}", arguments.count.saturating_sub(1)),
    };
    for run in runs {
        provenance.add_scene(&format!("{}, {trials}", run.family));
    }
    provenance.seeds = vec![SeedRange { first: arguments.seed, last: arguments.seed }];
    provenance
}

/// The requested scenes, sampled in parallel.
fn scenes(families: &[Family], arguments: &FamiliesArguments) -> Result<Vec<Drawn>, Failure> {
    let numbers: Vec<u64> = arguments.trial.map_or_else(|| (0..arguments.count).collect(), |trial| vec![trial]);
    let keys: Vec<_> = families.iter().flat_map(|family| numbers.iter().map(move |&trial| (family, trial))).collect();
    let draw = |&(family, trial): &(&Family, u64)| {
        let draw = family.draw_with(arguments.seed, trial, &arguments.values.of(family)?)?;
        Ok(Drawn { family: family.name.to_string(), number: trial, draw })
    };
    in_parallel(&keys, arguments.jobs.threads(), draw, |_| ()).into_iter().collect()
}

/// The families with these names or paths, each once, the built-in ones first. Without any, all that run by default.
fn chosen(names: &[PathBuf], files: &mut CommandFiles) -> Result<Vec<Family>, Failure> {
    let is_chosen = |family: &Family| {
        if names.is_empty() { family.is_default } else { names.iter().any(|name| name == Path::new(&*family.name)) }
    };
    let mut chosen: Vec<Family> = FAMILIES.into_iter().filter(is_chosen).collect();
    for path in names.iter().filter(|name| FAMILIES.iter().all(|family| *name != Path::new(&*family.name))) {
        if !load::is_scenario(path) {
            return Err(Failure::NoSuchFamily { name: path.display().to_string() });
        }
        let family = load::family(path, files)?;
        if chosen.iter().any(|other| other.name == family.name) {
            return Err(Failure::SceneTwice { scene: family.name.into_owned() });
        }
        chosen.push(family);
    }
    Ok(chosen)
}

/// The trial with this `number` of a drawn scene, at its speed. Its array is not yet calibrated.
pub(super) fn drawn_trial(
    Draw { text, scene, speed }: &Draw,
    (program, policy_hash): (&Program, &Sha256),
    mismatch: &GivenMismatch,
    world: impl Fn(&Scene) -> WorldSetup,
    number: u64,
) -> Result<Trial, Failure> {
    let loaded = Loaded { value: scene.clone(), hash: Sha256::new_with_prefix(text) };
    let mut program = program.clone();
    program.set(SPEED.name, *speed, Dimension::SPEED).map_err(Failure::FamilySetting)?;
    let policy_hash = with_settings(policy_hash.clone(), [(SPEED.name, *speed)].into_iter());
    Ok(mismatch.trial((Path::new(&scene.name), loaded), (&Arc::new(program), policy_hash), world(scene), number)?)
}

/// Prints a scenario and the command that runs it.
fn print(Drawn { family, number, draw }: &Drawn, seed: u64) -> Result<(), Failure> {
    let speed = format_si(draw.speed, Dimension::SPEED);
    output::text(format_args!(
        "# trial {number} of {family}, seed {seed}; at its speed: vibrissa run FILE --set \"speed={speed}\"\n{}",
        draw.text
    ))
}

/// The runs with their verdicts, and their pictures. Reports the runs that did not pass.
fn with_verdicts(scenes: Vec<Drawn>, finished: Vec<Finished>) -> (Vec<FamilyRun>, Vec<Option<String>>) {
    let rows = scenes.into_iter().zip(finished).map(|(drawn, finished)| {
        let Drawn { family, number: trial, draw } = drawn;
        let Finished { result, figures } = finished;
        let passed = result.violations.is_empty();
        let run = FamilyRun { family, trial, about: draw.scene.description, speed: draw.speed, passed, result };
        if !passed {
            report_run(&run);
        }
        (run, figures.map(|figures| figures.picture))
    });
    rows.unzip()
}

fn report_run(run: &FamilyRun) {
    let FamilyRun { family, trial, about, speed, result, .. } = run;
    let speed = 100.0 * speed;
    let reasons = result.violations.join("; ");
    output::message(format_args!("{family}, trial {trial} ({about}, {speed:.0} cm/s): {reasons}"));
    report_dead_whiskers(&format!("{family}, trial {trial}"), result);
}

/// The counts of each family, at every speed and for all speeds together.
fn tallies(families: &[Family], runs: &[FamilyRun]) -> Vec<FamilyTally> {
    let speeds = || SPEEDS.into_iter().map(Some).chain([None]);
    let tallies = families.iter().flat_map(|family| speeds().map(|speed| FamilyTally::new(&family.name, speed, runs)));
    tallies.filter(|tally| tally.tally.runs > 0).collect()
}
