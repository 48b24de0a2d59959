//! `vibrissa bench`

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::report::RunResult;
use crate::scene::Outcome;
use crate::study::WorldKind;
use crate::study::bench::{BenchRow, POLICIES, SCENARIOS, TextFile, bench_page, bench_table};

use super::arguments::BenchArguments;
use super::batch::{Finished, run_all};
use super::exit::{Exit, Failure};
use super::input::{self, Loaded, Policy};
use super::job::Job;
use super::run::make_directory;
use super::{file, output};

pub(super) fn bench(arguments: &BenchArguments) -> Result<Exit, Failure> {
    let jobs = jobs(&policies(&arguments.policies)?)?;
    make_directory(arguments.out.as_deref())?;
    let finished = run_all(&jobs, arguments.jobs, |_| arguments.out.is_some())?;
    let (mut rows, mut pictures) = (Vec::with_capacity(finished.len()), Vec::with_capacity(finished.len()));
    for Finished { result, violations, picture } in finished {
        tell(&result);
        for violation in &violations {
            output::message(format_args!("{}, {}: {violation}", result.scenario, result.policy));
        }
        rows.push(BenchRow::new(result, violations.is_empty()));
        pictures.push(picture.unwrap_or_default());
    }
    let page = match &arguments.out {
        Some(directory) => Some(write_report(directory, &rows, &pictures)?),
        None => None,
    };
    if arguments.json {
        output::json(&rows)?;
    } else {
        output::result(bench_table(&rows))?;
        if let Some(page) = page {
            output::result(format_args!("report: {}", page.display()))?;
        }
    }
    Ok(if rows.iter().all(|row| row.passed) { Exit::Done } else { Exit::Unexpected })
}

/// The policies to run: those that are given, or else those that are built in. Their warnings are told.
fn policies(files: &[PathBuf]) -> Result<Vec<(PathBuf, Loaded<Policy>)>, Failure> {
    let policies = if files.is_empty() {
        let built_in = |file: &TextFile| Ok((file.path.into(), input::built_in_policy(file)?));
        POLICIES.iter().map(built_in).collect::<Result<Vec<_>, Failure>>()?
    } else {
        files.iter().map(|path| Ok((path.clone(), input::policy(path)?))).collect::<Result<Vec<_>, Failure>>()?
    };
    let name = |policy: &Loaded<Policy>| policy.value.artifact.program.name.clone();
    for (index, (path, policy)) in policies.iter().enumerate() {
        policy.value.tell_warnings();
        // Pictures are named after policies.
        if let Some((first, _)) = policies[..index].iter().find(|(_, first)| name(first) == name(policy)) {
            return Err(Failure::SameName { first: first.clone(), second: path.clone(), name: name(policy) });
        }
    }
    Ok(policies)
}

/// Every scenario under every policy; the policies of a scenario stand together.
fn jobs(policies: &[(PathBuf, Loaded<Policy>)]) -> Result<Vec<Job>, Failure> {
    let scenarios = SCENARIOS.iter().map(|file| Ok((file, input::built_in_scenario(file)?)));
    let scenarios = scenarios.collect::<Result<Vec<_>, Failure>>()?;
    let all = scenarios.iter().flat_map(|scenario| policies.iter().map(move |policy| (scenario, policy)));
    let job = |((file, scene), (_, policy)): (&(&TextFile, Loaded<_>), &(_, Loaded<Policy>))| {
        let scene: &crate::scene::Scene = &scene.value;
        let hashes = (Sha256::digest(file.text), policy.hash.clone().finalize());
        let program = policy.value.artifact.program.clone();
        Job::with(Path::new(file.path), scene.clone(), program, WorldKind::Mujoco, scene.seed, hashes)
    };
    Ok(all.map(job).collect())
}

fn tell(result: &RunResult) {
    let RunResult { scenario, policy, outcome, .. } = result;
    if *outcome != Outcome::Completed {
        let reason = result.reason.as_deref().unwrap_or("for no reason that is known");
        output::message(format_args!("{scenario}, {policy}: {outcome}: {reason}"));
    }
}

/// Writes all results, a picture of every run and the page that shows them; where that is.
fn write_report(directory: &Path, rows: &[BenchRow], pictures: &[String]) -> Result<PathBuf, Failure> {
    for (BenchRow { result, .. }, picture) in rows.iter().zip(pictures) {
        file::write(&directory.join(format!("{}-{}.svg", result.scenario, result.policy)), picture)?;
    }
    file::write(&directory.join("results.json"), serde_json::to_string_pretty(rows)? + "\n")?;
    let page = directory.join("index.html");
    file::write(&page, bench_page(rows, pictures))?;
    Ok(page)
}
