//! `vibrissa explain`

use crate::scene::Pruning;

use super::arguments::{ExplainArguments, World};
use super::exit::{Exit, Failure};
use super::{input, output};

pub(super) fn explain(arguments: &ExplainArguments) -> Result<Exit, Failure> {
    let scene = input::scenario(&arguments.scenario)?.value;
    let policy = match (&arguments.policy, &scene.policy) {
        (Some(policy), _) => policy.clone(),
        (None, Some(policy)) => input::beside(&arguments.scenario, policy),
        (None, None) => return Err(Failure::NoPolicy { scenario: arguments.scenario.clone() }),
    };
    let program = input::program(&policy)?.value;
    // What the rig lacks would otherwise look as if it were read.
    scene
        .rig
        .indices(&program.whiskers)
        .map_err(crate::run::BindError::from)
        .map_err(|cause| Failure::Execute { scenario: arguments.scenario.clone(), cause: cause.into() })?;
    let world = World::of(arguments.world, &scene);
    let pruning = Pruning::new(&scene.rig, &scene.solids, scene.start, &program.whiskers, world);
    if arguments.json {
        output::json(&pruning)?;
    } else {
        output::result(&pruning)?;
    }
    Ok(Exit::Done)
}
