//! `vibrissa bench`

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::file::{CommandFiles, Output, OutputError};
use crate::report::RunResult;
use crate::scene::{Outcome, Violation};
use crate::study::bench::{BenchRow, Conditions, POLICIES, SCENARIOS, TextFile, bench_page, bench_table, pooled_tips};

use super::arguments::BenchArguments;
use super::batch::{Finished, run_all};
use super::exit::{Exit, Failure};
use super::input::{self, Loaded, Policy};
use super::job::Job;
use super::run::make_directory;
use super::{estimators, output, tiers, timing};

pub(super) fn bench(arguments: &BenchArguments) -> Result<Exit, Failure> {
    if arguments.estimators {
        return estimators::estimators(arguments);
    }
    if !arguments.worlds.is_empty() {
        return tiers::tiers(arguments);
    }
    let conditions = conditions(arguments);
    let mut files = CommandFiles::new();
    let jobs = jobs(&policies(arguments, &mut files)?, &conditions, arguments)?;
    if let Some(repeats) = arguments.timing {
        return timing::timing(&jobs, repeats, arguments.json, arguments.columns);
    }
    make_directory(arguments.out.as_deref())?;
    let report = arguments.out.as_ref().map(|directory| Report::new(directory, &jobs, &mut files)).transpose()?;
    let (conditions, jobs): (Vec<_>, Vec<_>) = jobs.into_iter().unzip();
    let finished = run_all(&jobs, arguments.jobs, |_| arguments.out.is_some())?;
    let (mut rows, mut pictures) = (Vec::with_capacity(finished.len()), Vec::with_capacity(finished.len()));
    for (Finished { result, violations, picture }, conditions) in finished.into_iter().zip(conditions) {
        let row = BenchRow::new(result, violations.is_empty()).under(conditions);
        tell(&row, &violations);
        rows.push(row);
        pictures.push(picture.unwrap_or_default());
    }
    let page = report.map(|report| report.write(&rows, &pictures)).transpose()?;
    if arguments.json {
        output::json_list(&rows)?;
    } else {
        output::tables(&[bench_table(&rows)], arguments.columns.wide)?;
        output::result(pooled_tips(&rows))?;
        if let Some(page) = page {
            output::result(format_args!("report: {}", page.display()))?;
        }
    }
    Ok(if rows.iter().all(|row| row.passed) { Exit::Done } else { Exit::Unexpected })
}

/// The policies to run: those that are given, or else those that are built in, with their parameters set. Their warnings are told.
pub(super) fn policies(
    arguments: &BenchArguments,
    read: &mut CommandFiles,
) -> Result<Vec<(PathBuf, Loaded<Policy>)>, Failure> {
    let files = &arguments.policies;
    let policies = if files.is_empty() {
        let built_in = |file: &TextFile| Ok((file.path.into(), input::built_in_policy(file)?));
        POLICIES.iter().map(built_in).collect::<Result<Vec<_>, Failure>>()?
    } else {
        files.iter().map(|path| Ok((path.clone(), input::policy(path, read)?))).collect::<Result<Vec<_>, Failure>>()?
    };
    let name = |policy: &Loaded<Policy>| policy.value.artifact.program.name.clone();
    for (index, (path, policy)) in policies.iter().enumerate() {
        policy.value.tell_warnings();
        // Pictures are named after policies.
        if let Some((first, _)) = policies[..index].iter().find(|(_, first)| name(first) == name(policy)) {
            return Err(Failure::SameName { first: first.clone(), second: path.clone(), name: name(policy) });
        }
    }
    let set = |(path, policy): (PathBuf, _)| match arguments.settings.of(policy) {
        Ok(policy) => Ok((path, policy)),
        Err(cause) => Err(Failure::SetOf { policy: path, cause }),
    };
    policies.into_iter().map(set).collect()
}

/// The conditions that are asked for, each once.
fn conditions(arguments: &BenchArguments) -> Vec<Conditions> {
    let mut all: Vec<Conditions> = Vec::new();
    for &friction in &arguments.friction {
        let conditions = Conditions { friction, noise: arguments.noise };
        if !all.contains(&conditions) {
            all.push(conditions);
        }
    }
    all
}

/// Every scenario under every policy and all conditions; the runs of a scenario stand together.
fn jobs(
    policies: &[(PathBuf, Loaded<Policy>)],
    conditions: &[Conditions],
    arguments: &BenchArguments,
) -> Result<Vec<(Conditions, Job)>, Failure> {
    let scenarios = SCENARIOS.iter().map(|file| Ok((file, input::built_in_scenario(file)?)));
    let scenarios = scenarios.collect::<Result<Vec<_>, Failure>>()?;
    let mut jobs = Vec::with_capacity(scenarios.len() * policies.len() * conditions.len());
    for (file, scenario) in &scenarios {
        for (_, policy) in policies {
            for &conditions in conditions {
                let mut scene = scenario.value.clone();
                conditions.apply(&mut scene);
                let mut scenario_hash = Sha256::new_with_prefix(file.text);
                if !conditions.are_ideal() {
                    scenario_hash.update(format!("\0{conditions}"));
                }
                let hashes = (scenario_hash.finalize(), policy.hash.clone().finalize());
                let (program, seed) = (policy.value.artifact.program.clone(), scene.seed);
                let world = arguments.pruning.of(arguments.world, &scene);
                jobs.push((conditions, Job::with(Path::new(file.path), scene, program, world, seed, hashes)));
            }
        }
    }
    Ok(jobs)
}

/// Tells why a run did not complete, and what of a run of the scene as it is was not as its scenario expects.
fn tell(row: &BenchRow, violations: &[Violation]) {
    let RunResult { policy, outcome, reason, .. } = &row.result;
    let scene = row.scene();
    if *outcome != Outcome::Completed {
        let reason = reason.as_deref().unwrap_or("for no reason that is known");
        output::message(format_args!("{scene}, {policy}: {outcome}: {reason}"));
    }
    for violation in violations.iter().filter(|_| row.conditions.are_ideal()) {
        output::message(format_args!("{scene}, {policy}: {violation}"));
    }
}

/// The places for a picture of every run, all results, and the page that shows them.
struct Report {
    pictures: Vec<Output>,
    results: Output,
    page: Output,
}

impl Report {
    fn new(directory: &Path, jobs: &[(Conditions, Job)], files: &mut CommandFiles) -> Result<Self, OutputError> {
        let mut file = |name: &str| files.output("--out", &directory.join(name));
        let picture = |(conditions, job): &(Conditions, Job)| {
            let scene = conditions.named(&job.scene.name).replace(", ", "-").replace(' ', "-");
            file(&format!("{scene}-{}.svg", job.program.name))
        };
        let pictures = jobs.iter().map(picture).collect::<Result<_, _>>()?;
        Ok(Self { pictures, results: file("results.json")?, page: file("index.html")? })
    }

    /// Writes it; where the page is.
    fn write(self, rows: &[BenchRow], pictures: &[String]) -> Result<PathBuf, Failure> {
        for (file, picture) in self.pictures.into_iter().zip(pictures) {
            file.write(picture)?;
        }
        self.results.write(output::list(rows)? + "\n")?;
        let page = self.page.path().to_owned();
        self.page.write(bench_page(rows, pictures))?;
        Ok(page)
    }
}
