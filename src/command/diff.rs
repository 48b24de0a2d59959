//! `vibrissa inspect diff`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::inspect::{breakpoints, with_program};
use super::options::{ArrayOptions, Format, WorldOptions};
use super::output;
use super::provenance::of_trials;
use super::trials::{calibrated, say_calibrations};
use vibrissa_lab::built_in::{SCENARIOS, TextFile};
use vibrissa_lab::inspect::{Breakpoints, PolicyDifference, first_difference};
use vibrissa_lab::load::{self, LoadError, Loaded};
use vibrissa_lab::report::difference_tables;
use vibrissa_lab::trial::{Inputs, Trial};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::Scene;

const EXAMPLE: &str = "Example:\n  vibrissa inspect diff policies/thesis.fsm mine.fsm scenarios/box.yaml\n\nExit status: 0 the policies are equal in every tick; 1 they differ; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa inspect diff`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct DiffArguments {
    /// The policy whose commands move the platform
    #[arg(value_name = "POLICY")]
    first: PathBuf,
    /// The policy that receives the same samples
    #[arg(value_name = "OTHER")]
    second: PathBuf,
    /// Scenarios or names of built-in ones. Without any, those of the bench
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    #[command(flatten)]
    world: WorldOptions,
    #[command(flatten)]
    array: ArrayOptions,
    #[command(flatten)]
    format: Format,
}

pub(super) fn diff(arguments: &DiffArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let policies = [explained(&arguments.first, &mut files)?, explained(&arguments.second, &mut files)?];
    let mismatch = arguments.array.load(&mut files)?;
    let mut scenes = scenes(&arguments.scenarios, &mut files)?;
    for (path, Loaded { value: scene, hash }) in &mut scenes {
        mismatch.apply(scene, hash, 0).map_err(Failure::mismatch(path))?;
    }
    mismatch.check_effect(scenes.iter().map(|(_, scenario)| &scenario.value)).map_err(LoadError::from)?;
    let (mut differences, mut trials) = (Vec::new(), Vec::new());
    for (path, Loaded { value: scene, .. }) in scenes {
        let trial = |policy: &Breakpoints| {
            let world = arguments.world.of(&scene);
            let inputs = Inputs { scenario: path.clone(), ..Inputs::default() };
            let trial = Trial::new(scene.clone(), Arc::new(policy.explained.program.clone()));
            calibrated(&with_program(&Trial { world, inputs, ..trial }, policy), &mismatch)
        };
        let [first, second] = &policies;
        let (own, other) = (trial(first)?, trial(second)?);
        say_calibrations(std::iter::once(&own));
        differences.push(first_difference(&own, [first, second], &other).map_err(Failure::execute(&own))?);
        trials.extend([own, other]);
    }
    output::documents(arguments.format, &of_trials(&trials), &differences, || {
        differences.iter().flat_map(difference_tables).collect::<Vec<_>>()
    })?;
    let is_equal = |difference: &PolicyDifference| difference.first.is_none();
    Ok(if differences.iter().all(is_equal) { Exit::Done } else { Exit::Unexpected })
}

pub(super) fn explained(path: &Path, files: &mut CommandFiles) -> Result<Breakpoints, Failure> {
    let source = load::policy_text(path, files)?;
    breakpoints(&load::with_libraries(&source, files), &[])
}

pub(super) fn scenes(paths: &[PathBuf], files: &mut CommandFiles) -> Result<Vec<(PathBuf, Loaded<Scene>)>, Failure> {
    if paths.is_empty() {
        let built_in = |file: &TextFile| Ok((file.path.into(), load::built_in_scenario(file)?));
        return SCENARIOS.iter().map(built_in).collect();
    }
    paths.iter().map(|path| Ok((path.clone(), load::scenario(path, files)?))).collect()
}
