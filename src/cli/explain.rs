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
    let fitted = scene
        .rig
        .fitted(&program.whiskers, &program.optional)
        .map_err(crate::run::BindError::from)
        .map_err(|cause| Failure::Execute { scenario: arguments.scenario.clone(), cause: cause.into() })?;
    let read: Vec<_> = fitted.into_iter().flatten().map(|index| scene.rig.whiskers[index].name.clone()).collect();
    let world = World::of(arguments.world, &scene);
    let pruning = Pruning::new(&scene.rig, &scene.solids, scene.start, &read, world);
    if arguments.json {
        output::json(&pruning)?;
    } else {
        output::result(&pruning)?;
    }
    Ok(Exit::Done)
}
