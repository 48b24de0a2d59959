//! `vibrissa families`

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::family::{Draw, FAMILIES, Family, SPEEDS};
use crate::family::{FamilyRun, FamilyTally, families_table};
use crate::file::{CommandFiles, Output, OutputError};
use crate::scene::Violation;
use crate::study::bench::DEFAULT_POLICY;
use crate::study::in_parallel;
use vibrissa_runtime::units::{Dimension, format_si};

use super::arguments::FamiliesArguments;
use super::batch::{Finished, run_all, threads};
use super::exit::{Exit, Failure};
use super::input::{self, Loaded, Policy};
use super::job::Job;
use super::output;
use super::run::make_directory;
use super::settings::with_settings;

/// One of the family's scenes.
struct Trial {
    family: &'static str,
    number: u64,
    draw: Draw,
}

pub(super) fn families(arguments: &FamiliesArguments) -> Result<Exit, Failure> {
    if arguments.settings.has("speed") {
        return Err(Failure::DrawnSpeed);
    }
    let trials = trials(arguments)?;
    if arguments.print {
        for trial in &trials {
            print(trial, arguments.seed)?;
        }
        return Ok(Exit::Done);
    }
    let mut files = CommandFiles::new();
    let policy = match &arguments.policy {
        Some(path) => input::policy(path, &mut files)?,
        None => input::built_in_policy(&DEFAULT_POLICY)?,
    };
    policy.value.tell_warnings();
    let policy = arguments.settings.of(policy)?;
    let jobs = trials.iter().map(|trial| job(trial, &policy, arguments)).collect::<Result<Vec<_>, Failure>>()?;
    make_directory(arguments.out.as_deref())?;
    let report = arguments.out.as_ref().map(|directory| Report::new(directory, &trials, &mut files)).transpose()?;
    let is_drawn = |violations: &[Violation]| arguments.out.is_some() && !violations.is_empty();
    let finished = run_all(&jobs, arguments.jobs, is_drawn)?;
    let (runs, pictures) = judged(trials, finished);
    if let Some(report) = report {
        report.write(&runs, pictures)?;
    }
    if arguments.json {
        output::json_list(&runs)?;
    } else {
        output::tables(&[families_table(&tallies(&runs))], arguments.columns.wide)?;
    }
    Ok(if runs.iter().all(|run| run.passed) { Exit::Done } else { Exit::Unexpected })
}

/// The scenes that are asked for, drawn several at a time.
fn trials(arguments: &FamiliesArguments) -> Result<Vec<Trial>, Failure> {
    let families = chosen(&arguments.names)?;
    let numbers: Vec<u64> = arguments.trial.map_or_else(|| (0..arguments.count).collect(), |trial| vec![trial]);
    let keys: Vec<_> = families.iter().flat_map(|family| numbers.iter().map(move |&trial| (family, trial))).collect();
    let draw = |&(family, trial): &(&Family, u64)| {
        let draw = family.draw(arguments.seed, trial)?;
        Ok(Trial { family: family.name, number: trial, draw })
    };
    in_parallel(&keys, threads(arguments.jobs), draw, |_| ()).into_iter().collect()
}

/// The families with these names, each once, or all.
fn chosen(names: &[String]) -> Result<Vec<Family>, Failure> {
    if let Some(name) = names.iter().find(|name| FAMILIES.iter().all(|family| family.name != **name)) {
        return Err(Failure::NoSuchFamily { name: name.clone() });
    }
    let is_chosen = |family: &Family| names.is_empty() || names.iter().any(|name| name == family.name);
    Ok(FAMILIES.iter().copied().filter(is_chosen).collect())
}

fn job(trial: &Trial, policy: &Loaded<Policy>, arguments: &FamiliesArguments) -> Result<Job, Failure> {
    let Draw { text, scene, speed } = &trial.draw;
    let mut program = policy.value.artifact.program.clone();
    program.set("speed", *speed, Dimension::SPEED).map_err(Failure::FamilySetting)?;
    let hashes = (Sha256::digest(text), with_settings(policy.hash.clone(), [("speed", *speed)].into_iter()).finalize());
    let world = arguments.pruning.of(arguments.world, scene);
    Ok(Job::with(Path::new(&scene.name), scene.clone(), program, world, scene.seed, hashes))
}

/// Prints a scenario, and how it is run by itself.
fn print(Trial { family, number, draw }: &Trial, seed: u64) -> Result<(), Failure> {
    let speed = format_si(draw.speed, Dimension::SPEED);
    output::text(format_args!(
        "# trial {number} of {family}, seed {seed}; at its speed: vibrissa run FILE --set \"speed={speed}\"\n{}",
        draw.text
    ))
}

/// The places for all results and for pictures.
struct Report {
    pictures: Vec<Output>,
    results: Output,
}

impl Report {
    fn new(directory: &Path, trials: &[Trial], files: &mut CommandFiles) -> Result<Self, OutputError> {
        let mut file = |name: &str| files.output("--out", &directory.join(name));
        let pictures = trials.iter().map(|trial| file(&format!("{}.svg", trial.draw.scene.name)));
        Ok(Self { pictures: pictures.collect::<Result<_, _>>()?, results: file("results.jsonl")? })
    }

    /// Writes all results, and those pictures that there are.
    fn write(self, runs: &[FamilyRun], pictures: Vec<Option<String>>) -> Result<(), Failure> {
        for (file, picture) in self.pictures.into_iter().zip(pictures) {
            picture.map(|picture| file.write(picture)).transpose()?;
        }
        let mut lines = String::new();
        for run in runs {
            lines += &output::json_line(run)?;
        }
        Ok(self.results.write(lines)?)
    }
}

/// The runs with whether they passed, and their pictures. Tells those that did not.
fn judged(trials: Vec<Trial>, finished: Vec<Finished>) -> (Vec<FamilyRun>, Vec<Option<String>>) {
    let judged = trials.into_iter().zip(finished).map(|(trial, finished)| {
        let Trial { family, number: trial, draw } = trial;
        let Finished { result, violations, picture } = finished;
        let passed = violations.is_empty();
        let run = FamilyRun { family, trial, about: draw.scene.description, speed: draw.speed, passed, result };
        if !passed {
            tell(&run, &violations);
        }
        (run, picture)
    });
    judged.unzip()
}

fn tell(run: &FamilyRun, violations: &[Violation]) {
    let FamilyRun { family, trial, about, speed, result, .. } = run;
    let speed = 100.0 * speed;
    let reasons: Vec<String> = violations.iter().map(|violation| reason(violation, result.reason.as_deref())).collect();
    let reasons = reasons.join("; ");
    output::message(format_args!("{family}, trial {trial} ({about}, {speed:.0} cm/s): {reasons}"));
}

/// What is wrong with a run, which may have given a `reason` for its end.
fn reason(violation: &Violation, reason: Option<&str>) -> String {
    match (violation, reason) {
        (Violation::Outcome { found, .. }, Some(reason)) => format!("{found}: {reason}"),
        _ => violation.to_string(),
    }
}

/// What became of each family, at every speed and all together.
fn tallies(runs: &[FamilyRun]) -> Vec<FamilyTally> {
    let speeds = || SPEEDS.into_iter().map(Some).chain([None]);
    let tallies = FAMILIES.iter().flat_map(|family| speeds().map(|speed| FamilyTally::new(family.name, speed, runs)));
    tallies.filter(|tally| tally.tally.runs > 0).collect()
}
