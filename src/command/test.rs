//! `vibrissa test`: tests and properties of policies

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde::Serialize;
use sha2::Sha256;
use vibrissa_runtime::machine::Program;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, Jobs, WorldOption};
use super::output;
use super::progress::Progress;
use super::provenance::{of_runs, of_trials};
use super::test_property::{self, CasesTried, Property, SearchOptions, Simulated, Tried};
use super::trials::{self, ReportFiles, calibrated, make_directory, run_with_bar};
use vibrissa_declare::figures::Metric;
use vibrissa_lab::load::{self, GivenMismatch, LoadError, Loaded, Policy, PolicyText, WithoutEffect, with_settings};
use vibrissa_lab::property::Regressions;
use vibrissa_lab::results::{Document, RunResult};
use vibrissa_lab::trial::{Trial, violations};
use vibrissa_language::{PolicyTest, TestScenes};
use vibrissa_text::diagnostic::{Diagnostic, Record, Source, Span, records};
use vibrissa_text::file::{CommandFiles, Output, OutputError};

const EXAMPLE: &str = "Example:\n  vibrissa test policies/vibrissa.fsm --filter corner\n  vibrissa test mine.fsm --cases 200 --simulator quasistatic --out out\n  vibrissa test mine.fsm --mismatch scenarios/mismatch/plausible.yaml\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa test`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct TestArguments {
    /// Policy files or names of built-in policies such as `thesis`
    #[arg(value_name = "POLICY", required = true)]
    policies: Vec<PathBuf>,
    /// Run only tests and properties with this text in their title
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
    #[command(flatten)]
    world: WorldOption,
    #[command(flatten)]
    array: ArrayOptions,
    #[command(flatten)]
    search: SearchOptions,
    /// Write a picture and the result of every test's run into this directory, and of a property that fails also the scenario
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    jobs: Jobs,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// The result of one test or property.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Tested {
    file: String,
    title: String,
    passed: bool,
    /// The expectations that do not hold.
    diagnostics: Vec<Record>,
    /// The cases of a property. `null` for a test.
    property: Option<CasesTried>,
    /// The run of a test, or the simplest run that violates a property. `null` for a property that holds.
    result: Option<RunResult>,
}

impl Document for Tested {
    const FORMAT: &'static str = "test";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// The tests of one policy.
struct Prepared<'a> {
    source: Source,
    tests: Vec<Runs<'a>>,
    regressions: Regressions,
}

/// The runs of a test or a property.
enum Runs<'a> {
    Test(PolicyTest, Box<Trial>),
    Property(Box<Property<'a>>),
}

impl Runs<'_> {
    fn title(&self) -> &str {
        match self {
            Self::Test(test, _) => &test.title,
            Self::Property(property) => property.title(),
        }
    }

    /// The trial of a test.
    fn trial(&self) -> Option<&Trial> {
        match self {
            Self::Test(_, trial) => Some(trial),
            Self::Property(_) => None,
        }
    }
}

pub(super) fn test(arguments: &TestArguments) -> Result<Exit, Failure> {
    // An error in the last policy or scenario is reported before the first run.
    let mut files = CommandFiles::new();
    let mismatch = arguments.array.load(&mut files)?;
    let prepared = arguments.policies.iter().map(|path| prepare(path, arguments, &mismatch, &mut files));
    let mut prepared = prepared.collect::<Result<Vec<_>, Failure>>()?;
    let tests = || prepared.iter().flat_map(|policy| &policy.tests);
    let count = tests().count();
    if let (0, Some(filter)) = (count, &arguments.filter) {
        return Err(Failure::NoSuchTest { filter: filter.clone() });
    }
    mismatch.check_effect(tests().filter_map(Runs::trial).map(|trial| &trial.scene)).map_err(LoadError::from)?;
    let properties = tests().filter(|runs| matches!(runs, Runs::Property(_))).count();
    if arguments.search.seed.is_some() && properties == 0 {
        return Err(LoadError::from(WithoutEffect::Cases).into());
    }
    make_directory(arguments.out.as_deref())?;
    let reports = (1..).zip(tests()).map(|(number, runs)| {
        let stem = arguments.out.as_ref().map(|directory| directory.join(file_name(number, runs.title())));
        stem.map(|stem| Report::new(&stem, runs, &mut files)).transpose()
    });
    let mut reports = reports.collect::<Result<Vec<_>, _>>()?.into_iter();

    let mut progress = None;
    let mut tested = Vec::with_capacity(count);
    for Prepared { source, tests, regressions } in &mut prepared {
        for runs in tests {
            let report = reports.next().flatten();
            tested.push(match runs {
                Runs::Test(test, trial) => {
                    run_test(source, test, &calibrated(trial, &mismatch)?, report, arguments.json)?
                }
                Runs::Property(property) => {
                    let progress = progress.get_or_insert_with(|| Progress::new(properties * arguments.search.cases));
                    run_property(source, property, regressions, report, arguments, progress)?
                }
            });
        }
    }
    if let Some(progress) = progress {
        progress.finish();
    }
    let results = tested.iter().filter_map(|tested| tested.result.as_ref());
    output::calibrations(results.filter_map(|result| result.calibration.as_ref()));
    let failed = tested.iter().filter(|tested| !tested.passed).count();
    if arguments.json {
        let provenance = of_runs(tested.iter().filter_map(|tested| tested.result.as_ref()));
        output::json_list(&provenance, &tested)?;
    } else {
        output::result(format_args!("{count} test{}, {failed} failed", if count == 1 { "" } else { "s" }))?;
    }
    Ok(if failed > 0 { Exit::Unexpected } else { Exit::Done })
}

/// Reads a policy and prepares its tests.
fn prepare<'a>(
    path: &Path,
    arguments: &'a TestArguments,
    mismatch: &'a GivenMismatch,
    files: &mut CommandFiles,
) -> Result<Prepared<'a>, Failure> {
    let simulated = Simulated { world: &arguments.world, mismatch, options: &arguments.array };
    let Loaded { value: Policy { artifact, text }, hash } = load::tested_policy(path, files)?;
    let text = text.ok_or_else(|| Failure::NoText { policy: path.to_owned() })?;
    output::diagnostics(&text.source, &text.warnings);
    let wanted =
        |test: &&PolicyTest| arguments.filter.as_ref().is_none_or(|filter| test.title.contains(filter.as_str()));
    let mut tests = Vec::new();
    for test in text.tests.iter().filter(wanted).cloned() {
        let program = artifact.program.clone();
        tests.push(match &test.scenes {
            TestScenes::Scenario { file, span } => {
                let file = (file.as_str(), *span);
                let trial = trial_of(path, &text, file, &test, program, hash.clone(), simulated, files)?;
                Runs::Test(test, Box::new(trial))
            }
            TestScenes::Family { entry, ranges } => {
                let scenes = (*entry, ranges.clone());
                Runs::Property(Box::new(Property::new(test, scenes, program, hash.clone(), simulated)?))
            }
        });
    }
    Ok(Prepared { source: text.source, tests, regressions: Regressions::read(path, files)? })
}

/// The files for the report of a test, and the scenario of a property.
struct Report {
    files: ReportFiles,
    scenario: Option<Output>,
}

impl Report {
    fn new(stem: &Path, runs: &Runs<'_>, files: &mut CommandFiles) -> Result<Self, OutputError> {
        let scenario = match runs {
            Runs::Test(..) => None,
            Runs::Property(_) => Some(files.output("--out", &trials::extended(stem, "yaml"))?),
        };
        Ok(Self { files: ReportFiles::new(stem, files)?, scenario })
    }
}

/// Runs a test and prints its verdict.
fn run_test(
    source: &Source,
    test: &PolicyTest,
    trial: &Trial,
    report: Option<Report>,
    json: bool,
) -> Result<Tested, Failure> {
    let finished = run_with_bar(trial, &mut ())?;
    let result = trial.document(&finished);
    let faults = violations(test, &trial.program, &finished);
    if let Some(report) = report {
        report.files.write(&of_trials([trial]), trial, &finished, &result)?;
    }
    if !json {
        print_verdict(source, test, &result, &faults)?;
    }
    Ok(Tested {
        file: source.name.clone(),
        title: test.title.clone(),
        passed: faults.is_empty(),
        diagnostics: records(source, &faults),
        property: None,
        result: Some(result),
    })
}

/// Tries the cases of a property, prints its verdict, and keeps a case that failed for the first time.
fn run_property(
    source: &Source,
    property: &Property<'_>,
    regressions: &mut Regressions,
    report: Option<Report>,
    arguments: &TestArguments,
    progress: &mut Progress,
) -> Result<Tested, Failure> {
    let TestArguments { search, jobs, json, .. } = arguments;
    let Tried { cases, failing } = property.run(regressions, *search, *jobs, progress)?;
    if !json {
        test_property::print_verdict(source, property, &cases, failing.as_ref())?;
    }
    if let (Some(failing), Some(Report { files, scenario })) = (&failing, report) {
        files.write(&of_trials([&failing.trial]), &failing.trial, &failing.finished, &failing.result)?;
        scenario.map(|file| file.write(failing.scenario.as_str())).transpose()?;
    }
    if let Some(failing) = failing.as_ref().filter(|failing| failing.is_new && !search.no_keep) {
        regressions.keep(property.title(), property.family(), &failing.case)?;
        output::message(format_args!("this case is kept in {}", regressions.path().display()));
    }
    let faults = failing.as_ref().map(|failing| failing.faults.as_slice()).unwrap_or_default();
    Ok(Tested {
        file: source.name.clone(),
        title: property.title().to_owned(),
        passed: failing.is_none(),
        diagnostics: records(source, faults),
        property: Some(cases),
        result: failing.map(|failing| failing.result),
    })
}

/// Prepares the run of a test.
#[expect(clippy::too_many_arguments, reason = "it has one caller")]
fn trial_of(
    policy: &Path,
    text: &PolicyText,
    (file, span): (&str, Span),
    test: &PolicyTest,
    mut program: Program,
    policy_hash: Sha256,
    simulated: Simulated<'_>,
    files: &mut CommandFiles,
) -> Result<Trial, Failure> {
    let path = policy.parent().unwrap_or(Path::new("")).join(file);
    let scene = load::scenario(&path, files).map_err(|failure| match failure {
        LoadError::Read { cause, .. } | LoadError::Missing { cause, .. } => {
            let message = format!("cannot read {}: {cause}", path.display());
            let fault = Diagnostic::error("P0702", message, span, "this scenario")
                .hint("a path starts from the folder of the policy");
            LoadError::at(&text.source, fault)
        }
        other => other,
    })?;
    test.set(&mut program);
    output::warn_of_rates(&path, &scene.value.rig, &program);
    let settings = test.settings.iter().map(|&(index, value)| (program.parameters[index].name.as_str(), value));
    let policy_hash = with_settings(policy_hash, settings);
    let world = simulated.world.of(&scene.value).into();
    Ok(simulated.mismatch.trial((&path, scene), (&Arc::new(program), policy_hash), world, 0)?)
}

/// Prints whether a test has passed. The outcome of a passed run was expected, even if it is a failure, and is not
/// reported.
fn print_verdict(source: &Source, test: &PolicyTest, result: &RunResult, faults: &[Diagnostic]) -> Result<(), Failure> {
    let verdict = if faults.is_empty() { "ok    " } else { "FAILED" };
    let (sim_s, wall_s) = (result.figure(Metric::SimulatedTime).unwrap_or_default(), result.wall_s);
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
