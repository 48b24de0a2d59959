//! `vibrissa explain`

use crate::file::CommandFiles;
use crate::mujoco::Pruning;

use super::arguments::{ExplainArguments, World};
use super::exit::{Exit, Failure};
use super::{input, output};

pub(super) fn explain(arguments: &ExplainArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let source = input::read(&arguments.scenario, &mut files)?;
    let scene = input::scenario_in(&source, &mut files)?.value;
    let policy = input::policy_for(arguments.policy.as_deref(), &scene, &source, &mut files)?;
    let program = policy.value.artifact.program;
    // What the rig lacks would otherwise look as if it were read.
    let fitted = scene
        .rig
        .fitted(&program.whiskers, &program.optional)
        .map_err(vibrissa_runtime::control::BindError::from)
        .map_err(|cause| Failure::Execute { scenario: arguments.scenario.clone(), cause: cause.into() })?;
    let read: Vec<_> = fitted.into_iter().flatten().map(|index| scene.rig.whiskers[index].name.clone()).collect();
    let world = World::of(arguments.world, &scene);
    let pruning = Pruning::new(&scene.rig, &scene.physics, &scene.solids, scene.start, &read, world);
    if arguments.json {
        output::json(&pruning)?;
    } else {
        output::result(&pruning)?;
    }
    Ok(Exit::Done)
}
