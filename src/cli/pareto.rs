//! `vibrissa pareto`

use std::sync::Arc;

use crate::study::bench::{DEFAULT_POLICY, SCENARIOS};
use crate::study::pareto::{Setting, measure, pareto_picture, pareto_table};
use crate::study::{Ending, check_world};

use super::arguments::{ParetoArguments, World};
use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::run::make_directory;
use super::{file, input, output};

pub(super) fn pareto(arguments: &ParetoArguments) -> Result<Exit, Failure> {
    let (path, scenario) = match &arguments.scenario {
        Some(path) => (path.clone(), input::scenario(path)?),
        None => (SCENARIOS[0].path.into(), input::built_in_scenario(&SCENARIOS[0])?),
    };
    let policy = match &arguments.policy {
        Some(path) => input::policy(path)?,
        None => input::built_in_policy(&DEFAULT_POLICY)?,
    };
    policy.value.tell_warnings();
    let (scene, program) = (scenario.value, Arc::new(policy.value.artifact.program));
    let world = World::of(None, &scene);
    let failed = |cause| Failure::Execute { scenario: path.clone(), cause };
    check_world(world).map_err(failed)?;
    make_directory(arguments.out.as_deref())?;
    let (settings, repeats) = (Setting::all(&scene, world), arguments.repeats.get());
    let mut progress = Progress::new(settings.len() * repeats);
    let measured = measure(&scene, &program, world, &settings, repeats, |setting| progress.done(setting));
    progress.finish();
    let pareto = measured.map_err(failed)?;
    for row in pareto.settings.iter().filter(|row| row.outcome != Ending::Completed) {
        let reason = row.reason.as_deref().unwrap_or("for no reason that is known");
        output::message(format_args!("{}: {reason}", row.setting));
    }
    if let Some(directory) = &arguments.out {
        let stem = directory.join(format!("{}-pareto", pareto.scenario));
        file::write(&stem.with_extension("json"), serde_json::to_string_pretty(&pareto)? + "\n")?;
        file::write(&stem.with_extension("svg"), pareto_picture(&pareto))?;
    }
    if arguments.json {
        output::json(&pareto)?;
    } else {
        output::result(pareto_table(&pareto))?;
    }
    Ok(Exit::Done)
}
