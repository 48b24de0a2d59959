//! `vibrissa test`

use crate::report::Document;
use std::path::Path;

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::diagnostic::{Diagnostic, Record, Source, records};
use crate::file::CommandFiles;
use crate::policy::PolicyTest;
use crate::report::RunResult;
use crate::score::Score;
use crate::study::violations;
use vibrissa_runtime::machine::Program;

use super::arguments::World;
use super::exit::{Exit, Failure};
use super::input::{self, Loaded, Policy, PolicyText};
use super::job::{Job, ReportFiles};
use super::language_arguments::TestArguments;
use super::settings::with_settings;
use super::{job, output, run};

/// What came of one test.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Tested {
    file: String,
    title: String,
    passed: bool,
    /// What was not as expected.
    diagnostics: Vec<Record>,
    result: RunResult,
}

impl Document for Tested {
    const FORMAT: &'static str = "test";
}

pub(super) fn test(arguments: &TestArguments) -> Result<Exit, Failure> {
    // Whatever is wrong with the last policy or scenario should show before the first has run.
    let (mut prepared, mut files) = (Vec::new(), CommandFiles::new());
    for path in &arguments.policies {
        let Loaded { value: Policy { artifact, text }, hash } = input::policy(path, &mut files)?;
        let text = text.ok_or_else(|| Failure::NoText { policy: path.clone() })?;
        output::diagnostics(&text.source, &text.warnings);
        let wanted =
            |test: &&PolicyTest| arguments.filter.as_ref().is_none_or(|filter| test.title.contains(filter.as_str()));
        let jobs = text.tests.iter().filter(wanted).map(|test| {
            let job = job_of(path, &text, test, artifact.program.clone(), hash.clone(), arguments, &mut files)?;
            Ok((test.clone(), job))
        });
        let jobs = jobs.collect::<Result<Vec<_>, Failure>>()?;
        prepared.push((text.source, jobs));
    }
    let count: usize = prepared.iter().map(|(_, jobs)| jobs.len()).sum();
    if let (0, Some(filter)) = (count, &arguments.filter) {
        return Err(Failure::NoSuchTest { filter: filter.clone() });
    }
    run::make_directory(arguments.out.as_deref())?;
    let tests = prepared.iter().flat_map(|(_, jobs)| jobs);
    let reports = (1..).zip(tests).map(|(number, (test, _))| {
        let stem = arguments.out.as_ref().map(|directory| directory.join(file_name(number, &test.title)));
        stem.map(|stem| ReportFiles::new(&stem, &mut files)).transpose()
    });
    let mut reports = reports.collect::<Result<Vec<_>, _>>()?.into_iter();

    let mut tested = Vec::with_capacity(count);
    for (source, jobs) in &prepared {
        for (test, job) in jobs {
            let run = job.execute_with_bar()?;
            let score = Score::new(&run, &job.scene.truth, &job.scene.rig);
            let result = job.result(&run, &score);
            let faults = violations(test, &job.program, &run, &score);
            if let Some(report) = reports.next().flatten() {
                job.write_report(report, &run, &score, &result)?;
            }
            if !arguments.json {
                tell(source, test, &result, &faults)?;
            }
            tested.push(Tested {
                file: source.name.clone(),
                title: test.title.clone(),
                passed: faults.is_empty(),
                diagnostics: records(source, &faults),
                result,
            });
        }
    }
    let failed = tested.iter().filter(|tested| !tested.passed).count();
    if arguments.json {
        output::json_list(&tested)?;
    } else {
        output::result(format_args!("{count} test{}, {failed} failed", if count == 1 { "" } else { "s" }))?;
    }
    Ok(if failed > 0 { Exit::Unexpected } else { Exit::Done })
}

/// Prepares the run of a test.
fn job_of(
    policy: &Path,
    text: &PolicyText,
    test: &PolicyTest,
    mut program: Program,
    policy_hash: Sha256,
    arguments: &TestArguments,
    files: &mut CommandFiles,
) -> Result<Job, Failure> {
    let path = policy.parent().unwrap_or(Path::new("")).join(&test.scenario);
    let Loaded { value: scene, hash } = input::scenario(&path, files).map_err(|failure| match failure {
        Failure::Read { cause, .. } => {
            let message = format!("cannot read {}: {cause}", path.display());
            let fault = Diagnostic::error("P0702", message, test.scenario_span, "this scenario")
                .hint("a path starts from the folder of the policy");
            Failure::Faults { source_text: Box::new(text.source.clone()), faults: vec![fault] }
        }
        other => other,
    })?;
    test.set(&mut program);
    let settings = test.settings.iter().map(|&(index, value)| (program.parameters[index].name.as_str(), value));
    let policy_hash = with_settings(policy_hash, settings);
    let (seed, world) = (scene.seed, World::of(arguments.world, &scene).into());
    let hashes = (hash.finalize(), policy_hash.finalize());
    Ok(Job::with(&path, scene, program, world, seed, hashes))
}

/// Prints whether a test has passed. How the run of one ended that has, be it by a failure, is what was expected, and not told.
fn tell(source: &Source, test: &PolicyTest, result: &RunResult, faults: &[Diagnostic]) -> Result<(), Failure> {
    let verdict = if faults.is_empty() { "ok    " } else { "FAILED" };
    let RunResult { sim_s, wall_s, .. } = result;
    output::result(format_args!("{verdict} {}: {} ({sim_s:.1} s in {wall_s:.2} s)", source.name, test.title))?;
    if !faults.is_empty() {
        job::tell(result);
        output::diagnostics(source, faults);
    }
    Ok(())
}

/// The name of a test's report: its number keeps titles apart that differ only in what files cannot be called.
fn file_name(number: usize, title: &str) -> String {
    let title: String =
        title.chars().map(|letter| if letter.is_alphanumeric() { letter } else { '-' }).take(60).collect();
    format!("{number:02}-{title}")
}
