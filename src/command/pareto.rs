//! `vibrissa study pareto`

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use vibrissa_runtime::machine::Program;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, Format, Policies};
use super::output;
use super::progress::Progress;
use super::provenance::of_trials;
use super::report_folder::{ReportFolder, say};
use super::values::parse_repeats;
use vibrissa_lab::built_in::{PLAUSIBLE_MISMATCH, SCENARIOS};
use vibrissa_lab::load::{self, LoadError, Loaded};
use vibrissa_lab::report::{pareto_page, pareto_picture, pareto_table};
use vibrissa_lab::results::Document;
use vibrissa_lab::study::pareto::{Setting, measure};
use vibrissa_lab::trial::{Trial, check_world};
use vibrissa_text::file::CommandFiles;

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
    let given = if scene.mismatch.is_none() { given.or_built_in(PLAUSIBLE_MISMATCH)? } else { given };
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
    let file = |policy: &str, extension| format!("{}-{policy}-pareto.{extension}", scene.name);
    let names = programs.iter().flat_map(|program| ["json", "svg"].map(|extension| file(&program.name, extension)));
    let mut report = ReportFolder::new("pareto", arguments.out.as_deref(), names, &mut files)?;
    let (settings, repeats) = (Setting::all(&scene, world), arguments.repeats);
    let mut progress = Progress::new(programs.len() * settings.len() * (repeats + 1));
    let mut measured = Vec::with_capacity(programs.len());
    for program in &programs {
        let pareto = measure(&scene, &wrong, program, world, &settings, repeats, |setting| progress.done(setting));
        measured.push(pareto.map_err(failed)?);
    }
    progress.finish();
    for (pareto, program) in measured.iter().zip(&programs) {
        for row in pareto.settings.iter().filter(|row| !row.outcome.met_its_stop()) {
            let reason = row.reason.as_deref().unwrap_or("unknown reason");
            output::message(format_args!("{}: {}: {reason}", pareto.policy, row.setting));
        }
        if let Some(report) = &mut report {
            let document = serde_json::to_string_pretty(&pareto.versioned(Some(&provenance)))?;
            report.write(&file(&program.name, "json"), document + "\n")?;
            report.write(&file(&program.name, "svg"), pareto_picture(pareto))?;
        }
    }
    output::calibrations(measured.iter().filter_map(|pareto| pareto.calibration.as_ref()));
    output::documents(arguments.format, &provenance, &measured, || {
        measured.iter().map(pareto_table).collect::<Vec<_>>()
    })?;
    let page = report.map(|report| report.finish(pareto_page(&provenance, &measured))).transpose()?;
    say(page, arguments.format)?;
    Ok(Exit::Done)
}
