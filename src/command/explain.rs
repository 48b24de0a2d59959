//! `vibrissa inspect explain`

use std::path::PathBuf;

use clap::Args;
use vibrissa_runtime::control::BindError;

use super::exit::Exit;
use super::failure::Failure;
use super::options::WorldOption;
use super::output;
use super::provenance::{provenance, simulator};
use vibrissa_lab::load;
use vibrissa_lab::trial::pruning;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa inspect explain scenarios/round-tunnel.yaml\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa inspect explain`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ExplainArguments {
    /// Scenario file or name of a built-in scenario such as `disk`
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Policy, compiled machine or name of a built-in policy such as `thesis`. Overrides the policy that the scenario names. If it names
    /// none, `vibrissa.fsm` is used
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    #[command(flatten)]
    world: WorldOption,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub(super) fn explain(arguments: &ExplainArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let source = load::scenario_text(&arguments.scenario, &mut files)?;
    let scene = load::scenario_in(&source, &mut files)?.value;
    let policy = load::policy_for(arguments.policy.as_deref(), &scene, &source, &mut files)?;
    let program = policy.value.artifact.program;
    let refused = |cause| Failure::Execute { scenario: arguments.scenario.clone(), cause };
    // A whisker that the rig lacks must not count as read.
    let fitted = scene
        .rig
        .fitted(&program.whiskers, &program.optional)
        .map_err(BindError::from)
        .map_err(|cause| refused(cause.into()))?;
    let read: Vec<_> = fitted.into_iter().flatten().map(|index| scene.rig.whiskers[index].name.clone()).collect();
    let world = arguments.world.of(&scene);
    // The rig that is simulated.
    let (rig, physics) = match scene.true_array() {
        Some(array) => (array.rig.clone(), array.physics(&scene.physics)),
        None => (scene.rig.clone(), scene.physics.clone()),
    };
    let pruning = pruning(&scene, &rig, &physics, &read, world).map_err(refused)?;
    if arguments.json {
        let mut provenance = provenance();
        provenance.add_scene(&scene.name);
        provenance.add_policy(&program.name);
        provenance.add_simulator(simulator(world.name()));
        output::json(&provenance, &pruning)?;
    } else {
        output::result(&pruning)?;
    }
    Ok(Exit::Done)
}
