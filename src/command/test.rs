//! `vibrissa test`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde::Serialize;
use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::Program;

use super::exit::Exit;
use super::failure::Failure;
use super::options::WorldOption;
use super::output;
use super::trials::{self, ReportFiles, inputs, make_directory, run_with_bar};
use crate::diagnostic::{Diagnostic, Record, Source, records};
use crate::file::CommandFiles;
use crate::load::{self, LoadError, Loaded, Policy, PolicyText, with_settings};
use crate::policy::PolicyTest;
use crate::results::{Document, RunResult};
use crate::trial::{Trial, violations};

const EXAMPLE: &str = "Example:\n  vibrissa test policies/vibrissa.fsm --filter corner\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa test`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct TestArguments {
    /// Policy files
    #[arg(value_name = "POLICY", required = true)]
    policies: Vec<PathBuf>,
    /// Run only tests with this text in their title
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
    #[command(flatten)]
    world: WorldOption,
    /// Write a picture and the result of every test's run into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// The result of one test.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Tested {
    file: String,
    title: String,
    passed: bool,
    /// The expectations that do not hold.
    diagnostics: Vec<Record>,
    result: RunResult,
}

impl Document for Tested {
    const FORMAT: &'static str = "test";
}

pub(super) fn test(arguments: &TestArguments) -> Result<Exit, Failure> {
    // An error in the last policy or scenario is reported before the first run.
    let (mut prepared, mut files) = (Vec::new(), CommandFiles::new());
    for path in &arguments.policies {
        let Loaded { value: Policy { artifact, text }, hash } = load::policy(path, &mut files)?;
        let text = text.ok_or_else(|| Failure::NoText { policy: path.clone() })?;
        output::diagnostics(&text.source, &text.warnings);
        let wanted =
            |test: &&PolicyTest| arguments.filter.as_ref().is_none_or(|filter| test.title.contains(filter.as_str()));
        let trials = text.tests.iter().filter(wanted).map(|test| {
            let trial = trial_of(path, &text, test, artifact.program.clone(), hash.clone(), arguments, &mut files)?;
            Ok((test.clone(), trial))
        });
        let trials = trials.collect::<Result<Vec<_>, Failure>>()?;
        prepared.push((text.source, trials));
    }
    let count: usize = prepared.iter().map(|(_, trials)| trials.len()).sum();
    if let (0, Some(filter)) = (count, &arguments.filter) {
        return Err(Failure::NoSuchTest { filter: filter.clone() });
    }
    make_directory(arguments.out.as_deref())?;
    let tests = prepared.iter().flat_map(|(_, trials)| trials);
    let reports = (1..).zip(tests).map(|(number, (test, _))| {
        let stem = arguments.out.as_ref().map(|directory| directory.join(file_name(number, &test.title)));
        stem.map(|stem| ReportFiles::new(&stem, &mut files)).transpose()
    });
    let mut reports = reports.collect::<Result<Vec<_>, _>>()?.into_iter();

    let mut tested = Vec::with_capacity(count);
    for (source, trials) in &prepared {
        for (test, trial) in trials {
            let finished = run_with_bar(trial)?;
            let result = trial.document(&finished);
            let faults = violations(test, &trial.program, &finished);
            if let Some(report) = reports.next().flatten() {
                report.write(trial, &finished, &result)?;
            }
            if !arguments.json {
                print_verdict(source, test, &result, &faults)?;
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
fn trial_of(
    policy: &Path,
    text: &PolicyText,
    test: &PolicyTest,
    mut program: Program,
    policy_hash: Sha256,
    arguments: &TestArguments,
    files: &mut CommandFiles,
) -> Result<Trial, Failure> {
    let path = policy.parent().unwrap_or(Path::new("")).join(&test.scenario);
    let Loaded { value: scene, hash } = load::scenario(&path, files).map_err(|failure| match failure {
        LoadError::Read { cause, .. } => {
            let message = format!("cannot read {}: {cause}", path.display());
            let fault = Diagnostic::error("P0702", message, test.scenario_span, "this scenario")
                .hint("a path starts from the folder of the policy");
            LoadError::at(&text.source, fault)
        }
        other => other,
    })?;
    test.set(&mut program);
    output::warn_of_rates(&path, &scene.rig, &program);
    let settings = test.settings.iter().map(|&(index, value)| (program.parameters[index].name.as_str(), value));
    let policy_hash = with_settings(policy_hash, settings);
    let inputs = inputs(&path, &hash.finalize(), &policy_hash.finalize());
    Ok(Trial { world: arguments.world.of(&scene).into(), inputs, ..Trial::new(scene, Arc::new(program)) })
}

/// Prints whether a test has passed. The outcome of a passed run was expected, even if it is a failure, and is not
/// reported.
fn print_verdict(source: &Source, test: &PolicyTest, result: &RunResult, faults: &[Diagnostic]) -> Result<(), Failure> {
    let verdict = if faults.is_empty() { "ok    " } else { "FAILED" };
    let RunResult { sim_s, wall_s, .. } = result;
    output::result(format_args!("{verdict} {}: {} ({sim_s:.1} s in {wall_s:.2} s)", source.name, test.title))?;
    if !faults.is_empty() {
        trials::report_events(result);
        output::diagnostics(source, faults);
    }
    Ok(())
}

/// The name of a test's report. Its number distinguishes titles whose characters are not valid in file names.
fn file_name(number: usize, title: &str) -> String {
    let title: String =
        title.chars().map(|letter| if letter.is_alphanumeric() { letter } else { '-' }).take(60).collect();
    format!("{number:02}-{title}")
}
