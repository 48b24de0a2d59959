//! `vibrissa study pareto`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use vibrissa_runtime::machine::Program;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, Format, Policies};
use super::output;
use super::progress::Progress;
use super::provenance::of_trials;
use super::trials::{extended, make_directory};
use super::values::parse_repeats;
use vibrissa_lab::built_in::SCENARIOS;
use vibrissa_lab::load::{self, LoadError, Loaded};
use vibrissa_lab::report::{pareto_page, pareto_picture, pareto_table};
use vibrissa_lab::results::{Document, Provenance};
use vibrissa_lab::study::pareto::{Pareto, Setting, measure};
use vibrissa_lab::trial::{Trial, check_world};
use vibrissa_text::file::{CommandFiles, Output, OutputError};

const EXAMPLE: &str = "Example:\n  vibrissa study pareto scenarios/box.yaml --repeats 5 --out out\n  vibrissa study pareto --policy policies/thesis.fsm --mismatch scenarios/mismatch/hard.yaml\n\nExit status: 0 done, whichever settings are better; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study pareto`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ParetoArguments {
    /// Scenario. The default is the disk of the bench
    #[arg(value_name = "SCENARIO")]
    scenario: Option<PathBuf>,
    #[command(flatten)]
    policies: Policies,
    #[command(flatten)]
    array: ArrayOptions,
    /// Number of runs of every setting without a mismatch, from 1 to 1000. Run times are medians
    #[arg(long, value_name = "N", default_value = "3", allow_negative_numbers = true, value_parser = parse_repeats)]
    repeats: usize,
    /// Write the results, pictures of time against error and a page with both into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn pareto(arguments: &ParetoArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (path, Loaded { value: mut scene, mut hash }) = match &arguments.scenario {
        Some(path) => (path.clone(), load::scenario(path, &mut files)?),
        None => (SCENARIOS[0].path.into(), load::built_in_scenario(&SCENARIOS[0])?),
    };
    let given = arguments.array.load(&mut files)?;
    let given = if scene.mismatch.is_none() { given.or_plausible()? } else { given };
    given.apply(&mut scene, &mut hash, 0).map_err(Failure::mismatch(&path))?;
    given.check_effect(std::iter::once(&scene)).map_err(LoadError::from)?;
    let policies = arguments.policies.load(&mut files)?;
    let programs: Vec<_> = policies.into_iter().map(|policy| Arc::new(policy.value.artifact.program)).collect();
    let world = scene.world.unwrap_or_default();
    let failed = |cause| Failure::Execute { scenario: path.clone(), cause };
    check_world(world).map_err(failed)?;
    // The array is calibrated once, in the scene as it is. So its calibration does not compensate for the errors of a setting.
    let mut wrong = scene.clone();
    scene.mismatch = None;
    given.calibrate_scene(&mut wrong, world.into()).map_err(Failure::calibration(&path))?;
    let trial =
        |program: &Arc<Program>| Trial { world: world.into(), ..Trial::new(wrong.clone(), Arc::clone(program)) };
    let provenance = of_trials(&programs.iter().map(trial).collect::<Vec<_>>());
    make_directory(arguments.out.as_deref())?;
    let report = |program: &Arc<Program>| {
        let stem = |directory: &PathBuf| directory.join(format!("{}-{}-pareto", scene.name, program.name));
        arguments.out.as_ref().map(|directory| Report::new(&stem(directory), &mut files)).transpose()
    };
    let reports = programs.iter().map(report).collect::<Result<Vec<_>, _>>()?;
    let page = arguments.out.as_ref().map(|directory| files.output("--out", &directory.join("index.html")));
    let page = page.transpose()?;
    let (settings, repeats) = (Setting::all(&scene, world), arguments.repeats);
    let mut progress = Progress::new(programs.len() * settings.len() * (repeats + 1));
    let mut measured = Vec::with_capacity(programs.len());
    for program in &programs {
        let pareto = measure(&scene, &wrong, program, world, &settings, repeats, |setting| progress.done(setting));
        measured.push(pareto.map_err(failed)?);
    }
    progress.finish();
    for (pareto, report) in measured.iter().zip(reports) {
        for row in pareto.settings.iter().filter(|row| !row.outcome.met_its_stop()) {
            let reason = row.reason.as_deref().unwrap_or("unknown reason");
            output::message(format_args!("{}: {}: {reason}", pareto.policy, row.setting));
        }
        report.map(|report| report.write(&provenance, pareto)).transpose()?;
    }
    output::calibrations(measured.iter().filter_map(|pareto| pareto.calibration.as_ref()));
    output::documents(arguments.format, &provenance, &measured, || {
        measured.iter().map(pareto_table).collect::<Vec<_>>()
    })?;
    if let Some(page) = page {
        let path = page.path().display().to_string();
        page.write(pareto_page(&provenance, &measured))?;
        if !arguments.format.json {
            output::result(format_args!("report: {path}"))?;
        }
    }
    Ok(Exit::Done)
}

/// The files of a policy.
struct Report {
    results: Output,
    picture: Output,
}

impl Report {
    fn new(stem: &Path, files: &mut CommandFiles) -> Result<Self, OutputError> {
        let mut file = |extension| files.output("--out", &extended(stem, extension));
        Ok(Self { results: file("json")?, picture: file("svg")? })
    }

    fn write(self, provenance: &Provenance, pareto: &Pareto) -> Result<(), Failure> {
        self.results.write(serde_json::to_string_pretty(&pareto.versioned(Some(provenance)))? + "\n")?;
        self.picture.write(pareto_picture(pareto))?;
        Ok(())
    }
}
