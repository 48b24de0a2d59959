//! `vibrissa run`

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use sha2::Digest;

use crate::machine::Program;
use crate::report::{Failsafes, Hashes, Identity, RunResult, picture, table};
use crate::run::Run;
use crate::scene::Scene;
use crate::score::Score;
use crate::study::{WorldKind, engine_hash, execute};

use super::arguments::RunArguments;
use super::exit::{Exit, Failure};
use super::input::{Loaded, Policy};
use super::{input, output};

/// A run that is ready to begin.
struct Job {
    path: PathBuf,
    scene: Scene,
    program: Arc<Program>,
    seed: u64,
    identity: Identity,
}

pub(super) fn run(arguments: &RunArguments) -> Result<Exit, Failure> {
    // Whatever is wrong with the last scenario should show before the first has run.
    let mut told = BTreeSet::new();
    let jobs = arguments.scenarios.iter().map(|path| job(path, arguments, &mut told));
    let jobs = jobs.collect::<Result<Vec<_>, _>>()?;
    check_names(&jobs)?;
    if let Some(directory) = &arguments.out {
        std::fs::create_dir_all(directory).map_err(Failure::write(directory))?;
    }

    let mut results = Vec::with_capacity(jobs.len());
    let mut exit = Exit::Done;
    for job in jobs {
        let run = execute_with_progress(&job, arguments.world.into())?;
        let score = Score::new(&run, &job.scene.object);
        if let Some(reason) = &run.reason {
            output::message(format_args!("{}: {}: {reason}", job.identity.scenario, run.outcome));
        }
        for expectation in &job.scene.expect {
            if let Some(violation) = expectation.violation(run.outcome, |metric| score.figure(metric)) {
                output::message(format_args!("{}: {violation}", job.identity.scenario));
                exit = Exit::Unexpected;
            }
        }
        if let Some(touched) = body_contact(&run) {
            output::message(format_args!(
                "{}: the platform's body touched the object for {:.1} s",
                job.identity.scenario,
                touched.as_secs_f64()
            ));
        }
        let result = RunResult::new(job.identity, &run, &score);
        tell_failsafes(&result);
        if let Some(directory) = &arguments.out {
            write_report(directory, &job.scene, &run, &score, &result)?;
        }
        results.push(result);
    }

    if arguments.json {
        output::json(&results)?;
    } else {
        output::result(table(&results))?;
        if let Some(directory) = &arguments.out {
            for result in &results {
                output::result(format_args!("report: {}", report_path(directory, result, "svg").display()))?;
            }
        }
    }
    Ok(exit)
}

/// Prepares a run. Tells the warnings of its policy, unless the policy is among those `told` of.
fn job(path: &Path, arguments: &RunArguments, told: &mut BTreeSet<PathBuf>) -> Result<Job, Failure> {
    let scenario = input::scenario(path)?;
    let scene = scenario.value;
    let policy_path = match (&arguments.policy, &scene.policy) {
        (Some(policy), _) => policy.clone(),
        (None, Some(policy)) => path.parent().unwrap_or(Path::new("")).join(policy),
        (None, None) => return Err(Failure::NoPolicy { scenario: path.to_owned() }),
    };
    let Loaded { value: Policy { artifact, warned }, hash: mut policy_hash } = input::policy(&policy_path)?;
    if let Some((source, warnings)) = &warned
        && told.insert(policy_path)
    {
        output::diagnostics(source, warnings);
    }
    let mut program = artifact.program;
    for setting in &arguments.settings {
        program.set(&setting.name, setting.value.value_si, setting.value.dimension)?;
        policy_hash.update(format!("\0{}={}", setting.name, setting.value.value_si));
    }
    let engine = engine_hash(&scene).map_err(|cause| Failure::Solid { scenario: path.to_owned(), cause })?;
    let seed = arguments.seed.unwrap_or(scene.seed);
    let identity = Identity {
        scenario: scene.name.clone(),
        policy: program.name.clone(),
        world: WorldKind::from(arguments.world).to_string(),
        seed,
        hash: Hashes {
            scenario: input::short(&scenario.hash.finalize()),
            policy: input::short(&policy_hash.finalize()),
            engine: input::short(&engine),
        },
    };
    Ok(Job { path: path.to_owned(), scene, program: Arc::new(program), seed, identity })
}

/// Reports are named after scenarios, so that two of one name would overwrite each other.
fn check_names(jobs: &[Job]) -> Result<(), Failure> {
    for (index, job) in jobs.iter().enumerate() {
        if let Some(first) = jobs[..index].iter().find(|first| first.identity.scenario == job.identity.scenario) {
            let name = job.identity.scenario.clone();
            return Err(Failure::SameName { first: first.path.clone(), second: job.path.clone(), name });
        }
    }
    Ok(())
}

fn execute_with_progress(job: &Job, world: WorldKind) -> Result<Run, Failure> {
    // Drawn on standard error, and only if that is a terminal.
    let bar = ProgressBar::new(milliseconds(job.scene.stop.time));
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {percent} % of at most {prefix}, {elapsed}") {
        bar.set_style(style);
    }
    bar.set_message(job.identity.scenario.clone());
    bar.set_prefix(format!("{} s", job.scene.stop.time));
    let mut shown = 0.0;
    let run = execute(&job.scene, Arc::clone(&job.program), world, job.seed, |time| {
        if time - shown >= 1.0 {
            shown = time;
            bar.set_position(milliseconds(time));
        }
    });
    bar.finish_and_clear();
    run.map_err(|cause| Failure::Execute { scenario: job.path.clone(), cause })
}

fn milliseconds(seconds: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive time, only to be shown")]
    let milliseconds = (seconds * 1e3) as u64;
    milliseconds
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

/// For how long the platform's body touched something; `None` if it did not.
fn body_contact(run: &Run) -> Option<Duration> {
    let ticks = run.trace.ticks.iter().filter(|tick| tick.body_touches).count();
    (ticks > 0).then(|| Duration::from_secs_f64(ticks as f64 * run.trace.period))
}

fn write_report(directory: &Path, scene: &Scene, run: &Run, score: &Score, result: &RunResult) -> Result<(), Failure> {
    let picture_path = report_path(directory, result, "svg");
    let drawn = picture(scene, &result.policy, run, score);
    std::fs::write(&picture_path, drawn).map_err(Failure::write(&picture_path))?;
    let json_path = report_path(directory, result, "json");
    let json = serde_json::to_string_pretty(result)? + "\n";
    std::fs::write(&json_path, json).map_err(Failure::write(&json_path))
}

fn report_path(directory: &Path, result: &RunResult, extension: &str) -> PathBuf {
    directory.join(format!("{}.{extension}", result.scenario))
}
