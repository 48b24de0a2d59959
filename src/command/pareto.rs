//! `vibrissa pareto`

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
use super::progress::Progress;
use super::trials::{extended, make_directory};
use super::values::parse_repeats;
use crate::built_in::{DEFAULT_POLICY, SCENARIOS};
use crate::file::{CommandFiles, OutputError};
use crate::load;
use crate::report::{pareto_picture, pareto_table};
use crate::results::{Document, Ending};
use crate::study::pareto::{Setting, measure};
use crate::trial::check_world;

const EXAMPLE: &str = "Example:\n  vibrissa pareto scenarios/box.yaml --repeats 5 --out out\n\nExit status: 0 done, whichever settings are better; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa pareto`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ParetoArguments {
    /// Scenario. The default is the disk of the bench
    #[arg(value_name = "SCENARIO")]
    scenario: Option<PathBuf>,
    /// Policy or compiled machine. The default is `vibrissa.fsm`
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    /// Number of runs of every setting, from 1 to 1000. Run times are medians
    #[arg(long, value_name = "N", default_value = "3", allow_negative_numbers = true, value_parser = parse_repeats)]
    repeats: usize,
    /// Write the results and a picture of time against error into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn pareto(arguments: &ParetoArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (path, scenario) = match &arguments.scenario {
        Some(path) => (path.clone(), load::scenario(path, &mut files)?),
        None => (SCENARIOS[0].path.into(), load::built_in_scenario(&SCENARIOS[0])?),
    };
    let policy = match &arguments.policy {
        Some(path) => load::policy(path, &mut files)?,
        None => load::built_in_policy(&DEFAULT_POLICY)?,
    };
    output::warnings(&policy.value);
    let (scene, program) = (scenario.value, Arc::new(policy.value.artifact.program));
    let world = scene.world.unwrap_or_default();
    let failed = |cause| Failure::Execute { scenario: path.clone(), cause };
    check_world(world).map_err(failed)?;
    make_directory(arguments.out.as_deref())?;
    let report = arguments.out.as_ref().map(|directory| {
        let stem = directory.join(format!("{}-pareto", scene.name));
        Ok::<_, OutputError>([
            files.output("--out", &extended(&stem, "json"))?,
            files.output("--out", &extended(&stem, "svg"))?,
        ])
    });
    let report = report.transpose()?;
    let (settings, repeats) = (Setting::all(&scene, world), arguments.repeats);
    let mut progress = Progress::new(settings.len() * repeats);
    let measured = measure(&scene, &program, world, &settings, repeats, |setting| progress.done(setting));
    progress.finish();
    let pareto = measured.map_err(failed)?;
    for row in pareto.settings.iter().filter(|row| row.outcome != Ending::Completed) {
        let reason = row.reason.as_deref().unwrap_or("unknown reason");
        output::message(format_args!("{}: {reason}", row.setting));
    }
    if let Some([results, picture]) = report {
        results.write(serde_json::to_string_pretty(&pareto.versioned())? + "\n")?;
        picture.write(pareto_picture(&pareto))?;
    }
    output::document(arguments.format, &pareto, || [pareto_table(&pareto)])?;
    Ok(Exit::Done)
}
