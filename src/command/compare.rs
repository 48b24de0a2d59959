//! `vibrissa compare`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use sha2::{Digest, Sha256};

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, Format, Jobs, WorldOptions};
use super::output;
use super::provenance::of_runs;
use super::report_folder::{ReportFolder, say};
use super::trial_runs::run_all;
use super::values::{parse_jitter, parse_jitter_heading, parse_runs};
use vibrissa_lab::built_in::{SCENARIOS, TextFile};
use vibrissa_lab::load::{self, GivenMismatch, LoadError, Loaded};
use vibrissa_lab::report::{comparison_page, comparison_tables};
use vibrissa_lab::results::{Document, JitterRecord, Provenance, RunResult, marked};
use vibrissa_lab::study::compare::{Comparison, Incomplete, PolicyRuns};
use vibrissa_lab::trial::{Inputs, Trial};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{Jitter, Scene};

const EXAMPLE: &str = "Example:\n  vibrissa compare policies/thesis.fsm policies/vibrissa.fsm --seeds 20 --jitter \"10 mm\"\n\nExit status: 0 done, whichever policy is better; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa compare`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct CompareArguments {
    /// Two or more policies, and scenarios (.yaml), or names of built-in ones: thesis vibrissa box. The first policy is compared with each other one. The default scenarios are those of
    /// the bench
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Number of runs of each scenario, from 1 to 100000. The first run is the scenario itself. Each other run has its own seed of
    /// noise and start
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = parse_runs)]
    seeds: u64,
    /// Largest deviation of starts along x and y, from 0 to 10 m: --jitter "20 mm"
    #[arg(long, value_name = "LENGTH", default_value = "0 mm", allow_hyphen_values = true, value_parser = parse_jitter)]
    jitter: f64,
    /// Largest deviation of headings, from 0 to 180 deg: --jitter-heading "10 deg"
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", allow_hyphen_values = true, value_parser = parse_jitter_heading)]
    jitter_heading: f64,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    /// Write the comparison, all results and a page with the differences in words into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

/// The names of the files of the comparison and of all results.
const COMPARISON: &str = "comparison.json";
const RESULTS: &str = "results.json";

/// A scenario with one start and one seed.
struct Setting {
    path: PathBuf,
    scene: Scene,
    hash: Sha256,
}

pub(super) fn compare(arguments: &CompareArguments) -> Result<Exit, Failure> {
    let (scenarios, policies): (Vec<&PathBuf>, Vec<&PathBuf>) =
        arguments.files.iter().partition(|path| load::is_scenario(path));
    if policies.len() < 2 {
        return Err(Failure::TooFewPolicies { count: policies.len() });
    }
    let mut read = CommandFiles::new();
    let array = arguments.array.load(&mut read)?;
    let loaded = policies.iter().map(|path| load::policy(path, &mut read)).collect::<Result<Vec<_>, _>>()?;
    let settings = settings(&scenarios, &array, arguments, &mut read)?;
    array.check_effect(settings.iter().map(|setting| &setting.scene)).map_err(LoadError::from)?;
    let report =
        ReportFolder::new("compare", arguments.out.as_deref(), [COMPARISON, RESULTS].map(str::to_owned), &mut read)?;
    let mut trials = Vec::with_capacity(policies.len() * settings.len());
    for policy in &loaded {
        output::warnings(&policy.value);
        let program = Arc::new(policy.value.artifact.program.clone());
        for Setting { path, scene, hash } in &settings {
            let inputs = Inputs::new(path, hash.clone(), policy.hash.clone());
            let trial = Trial::new(scene.clone(), Arc::clone(&program));
            trials.push(Trial { world: arguments.world.of(scene), inputs, ..trial });
        }
    }
    let results = run_all(&trials, &array, arguments.jobs, report.as_ref(), |_| false)?;
    let mut results = results.into_iter().map(|finished| finished.result);
    let runs: Vec<_> = policies
        .iter()
        .map(|path| {
            let results: Vec<RunResult> = results.by_ref().take(settings.len()).collect();
            let true_tips = results.iter().any(|result| result.true_tips);
            (marked(&path.display().to_string(), true_tips), results)
        })
        .collect();
    let jitter = JitterRecord { position_m: arguments.jitter, heading_rad: arguments.jitter_heading };
    let is_jittered = jitter.position_m > 0.0 || jitter.heading_rad > 0.0;
    let provenance =
        Provenance { jitter: is_jittered.then_some(jitter), ..of_runs(runs.iter().flat_map(|(_, results)| results)) };
    let comparison = Comparison::new(&runs);
    report_incomplete(&comparison);
    let write = |mut report: ReportFolder| {
        let document = serde_json::to_string_pretty(&comparison.versioned(Some(&provenance)))?;
        report.write(COMPARISON, document + "\n")?;
        let results: Vec<RunResult> = runs.iter().flat_map(|(_, results)| results).cloned().collect();
        report.write(RESULTS, output::list(&provenance, &results)? + "\n")?;
        report.finish(comparison_page(&provenance, &comparison))
    };
    let page = report.map(write).transpose()?;
    output::document(arguments.format, &provenance, &comparison, || comparison_tables(&comparison))?;
    say(page, arguments.format)?;
    Ok(Exit::Done)
}

fn report_incomplete(comparison: &Comparison) {
    for PolicyRuns { policy, incomplete, .. } in &comparison.policies {
        for Incomplete { scenario, seed, outcome, reason } in incomplete {
            let reason = reason.as_deref().unwrap_or("unknown reason");
            output::message(format_args!("{policy}: {scenario}, seed {seed}: {outcome}: {reason}"));
        }
    }
}

/// The runs of every policy: each scenario as it is, and then with other seeds and starts.
fn settings(
    files: &[&PathBuf],
    mismatch: &GivenMismatch,
    arguments: &CompareArguments,
    read: &mut CommandFiles,
) -> Result<Vec<Setting>, Failure> {
    let scenarios: Vec<(PathBuf, Loaded<Scene>)> = if files.is_empty() {
        let built_in = |file: &TextFile| Ok((file.path.into(), load::built_in_scenario(file)?));
        SCENARIOS.iter().map(built_in).collect::<Result<_, Failure>>()?
    } else {
        files.iter().map(|path| Ok(((*path).clone(), load::scenario(path, read)?))).collect::<Result<_, Failure>>()?
    };
    for (index, (second, scenario)) in scenarios.iter().enumerate() {
        let name = &scenario.value.name;
        // A repeated run would count as a second pair.
        if let Some((first, _)) = scenarios[..index].iter().find(|(_, first)| first.value.name == *name) {
            return Err(Failure::SameName { first: first.clone(), second: second.clone(), name: name.clone() });
        }
    }
    let jitter = Jitter { position: arguments.jitter, heading: arguments.jitter_heading };
    let is_jittered = jitter.position > 0.0 || jitter.heading > 0.0;
    if is_jittered && arguments.seeds < 2 {
        output::message(format_args!(
            "--jitter does not affect the first run of a scenario; request more runs with --seeds"
        ));
    }
    let mut settings = Vec::new();
    for (path, Loaded { value: scene, hash }) in scenarios {
        let mut first = scene.clone();
        mismatch.apply(&mut first, &mut hash.clone(), 0).map_err(Failure::mismatch(&path))?;
        let differs = is_jittered || first.is_random();
        if !differs && arguments.seeds > 1 {
            output::message(format_args!(
                "{}: without noise or --jitter all seeds give the same run, so only one is run",
                path.display()
            ));
        }
        for number in 0..if differs { arguments.seeds } else { 1 } {
            let mut scene = Scene { seed: scene.seed.wrapping_add(number), ..scene.clone() };
            let mut hash = hash.clone();
            mismatch.apply(&mut scene, &mut hash, number).map_err(Failure::mismatch(&path))?;
            if is_jittered && number > 0 {
                scene.start = started(&path, &scene, &jitter)?;
                let start = [scene.start.position.x, scene.start.position.y, scene.start.heading];
                hash = start.iter().fold(hash, |hash, number| hash.chain_update(number.to_le_bytes()));
            }
            settings.push(Setting { path: path.clone(), scene, hash });
        }
    }
    Ok(settings)
}

fn started(path: &Path, scene: &Scene, jitter: &Jitter) -> Result<vibrissa_world::geometry::Pose, Failure> {
    let reason = "almost no start within the jitter is collision-free; make --jitter smaller";
    jitter.start(scene, scene.seed).ok_or_else(|| Failure::at(path)(reason))
}
