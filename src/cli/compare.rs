//! `vibrissa compare`

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::file::CommandFiles;
use crate::scene::{Jitter, Scene};
use crate::study::bench::{SCENARIOS, TextFile};
use crate::study::compare::{Comparison, Incomplete, PolicyRuns, comparison_tables};

use super::arguments::CompareArguments;
use super::batch::run_all;
use super::exit::{Exit, Failure};
use super::input::{self, Loaded};
use super::job::Job;
use super::output;

/// A scenario with one of its starts and one of its seeds.
struct Setting {
    path: PathBuf,
    scene: Scene,
    hash: Sha256,
}

pub(super) fn compare(arguments: &CompareArguments) -> Result<Exit, Failure> {
    let (scenarios, policies): (Vec<&PathBuf>, Vec<&PathBuf>) =
        arguments.files.iter().partition(|path| path.extension().is_some_and(|end| end == "yaml" || end == "yml"));
    if policies.len() < 2 {
        return Err(Failure::TooFewPolicies { count: policies.len() });
    }
    let mut read = CommandFiles::new();
    let settings = settings(&scenarios, arguments, &mut read)?;
    let mut jobs = Vec::with_capacity(policies.len() * settings.len());
    for path in &policies {
        let policy = input::policy(path, &mut read)?;
        policy.value.tell_warnings();
        for Setting { path, scene, hash } in &settings {
            let hashes = (hash.clone().finalize(), policy.hash.clone().finalize());
            let program = policy.value.artifact.program.clone();
            let world = arguments.pruning.of(arguments.world, scene);
            jobs.push(Job::with(path, scene.clone(), program, world, scene.seed, hashes));
        }
    }
    let mut results = run_all(&jobs, arguments.jobs, |_| false)?.into_iter().map(|finished| finished.result);
    let runs: Vec<_> = policies
        .iter()
        .map(|path| (path.display().to_string(), results.by_ref().take(settings.len()).collect()))
        .collect();
    let comparison = Comparison::new(&runs);
    tell_incomplete(&comparison);
    if arguments.json {
        output::json(&comparison)?;
    } else {
        output::tables(&comparison_tables(&comparison), arguments.columns.wide)?;
    }
    Ok(Exit::Done)
}

fn tell_incomplete(comparison: &Comparison) {
    for PolicyRuns { policy, incomplete, .. } in &comparison.policies {
        for Incomplete { scenario, seed, outcome, reason } in incomplete {
            let reason = reason.as_deref().unwrap_or("for no reason that is known");
            output::message(format_args!("{policy}: {scenario}, seed {seed}: {outcome}: {reason}"));
        }
    }
}

/// The runs that every policy does: each scenario as it is, and then with other seeds and starts.
fn settings(
    files: &[&PathBuf],
    arguments: &CompareArguments,
    read: &mut CommandFiles,
) -> Result<Vec<Setting>, Failure> {
    let scenarios: Vec<(PathBuf, Loaded<Scene>)> = if files.is_empty() {
        let built_in = |file: &TextFile| Ok((file.path.into(), input::built_in_scenario(file)?));
        SCENARIOS.iter().map(built_in).collect::<Result<_, Failure>>()?
    } else {
        files.iter().map(|path| Ok(((*path).clone(), input::scenario(path, read)?))).collect::<Result<_, Failure>>()?
    };
    for (index, (second, scenario)) in scenarios.iter().enumerate() {
        let name = &scenario.value.name;
        // The same runs twice would pretend to be two pairs.
        if let Some((first, _)) = scenarios[..index].iter().find(|(_, first)| first.value.name == *name) {
            return Err(Failure::SameName { first: first.clone(), second: second.clone(), name: name.clone() });
        }
    }
    let jitter = Jitter { position: arguments.jitter, heading: arguments.jitter_heading };
    let is_jittered = jitter.position > 0.0 || jitter.heading > 0.0;
    if is_jittered && arguments.seeds < 2 {
        output::message(format_args!(
            "--jitter does nothing to the first run of a scenario: ask for more with --seeds"
        ));
    }
    let mut settings = Vec::new();
    for (path, Loaded { value: scene, hash }) in scenarios {
        let differs = is_jittered || scene.rig.sensing.is_noisy();
        if !differs && arguments.seeds > 1 {
            output::message(format_args!(
                "{}: without noise or --jitter all seeds are the same run, so it is done once",
                path.display()
            ));
        }
        for number in 0..if differs { arguments.seeds } else { 1 } {
            let mut scene = Scene { seed: scene.seed.wrapping_add(number), ..scene.clone() };
            let mut hash = hash.clone();
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

fn started(path: &Path, scene: &Scene, jitter: &Jitter) -> Result<crate::geometry::Pose, Failure> {
    jitter.start(scene, scene.seed).ok_or_else(|| Failure::NoStart { scenario: path.to_owned() })
}
