//! `vibrissa pareto`

use crate::report::Document;
use std::sync::Arc;

use crate::file::{CommandFiles, OutputError};
use crate::study::bench::{DEFAULT_POLICY, SCENARIOS};
use crate::study::pareto::{Setting, measure, pareto_picture, pareto_table};
use crate::study::{Ending, check_world};

use super::arguments::{ParetoArguments, World};
use super::exit::{Exit, Failure};
use super::job::extended;
use super::progress::Progress;
use super::run::make_directory;
use super::{input, output};

pub(super) fn pareto(arguments: &ParetoArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (path, scenario) = match &arguments.scenario {
        Some(path) => (path.clone(), input::scenario(path, &mut files)?),
        None => (SCENARIOS[0].path.into(), input::built_in_scenario(&SCENARIOS[0])?),
    };
    let policy = match &arguments.policy {
        Some(path) => input::policy(path, &mut files)?,
        None => input::built_in_policy(&DEFAULT_POLICY)?,
    };
    policy.value.tell_warnings();
    let (scene, program) = (scenario.value, Arc::new(policy.value.artifact.program));
    let world = World::of(None, &scene);
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
        let reason = row.reason.as_deref().unwrap_or("for no reason that is known");
        output::message(format_args!("{}: {reason}", row.setting));
    }
    if let Some([results, picture]) = report {
        results.write(serde_json::to_string_pretty(&pareto.versioned())? + "\n")?;
        picture.write(pareto_picture(&pareto))?;
    }
    if arguments.json {
        output::json(&pareto)?;
    } else {
        output::tables(&[pareto_table(&pareto)], arguments.columns.wide)?;
    }
    Ok(Exit::Done)
}
