//! `vibrissa mjcf`

use crate::file::CommandFiles;

use super::arguments::MjcfArguments;
use super::exit::{Exit, Failure};
use super::{input, output};

pub(super) fn mjcf(arguments: &MjcfArguments) -> Result<Exit, Failure> {
    let scene = input::scenario(&arguments.scenario, &mut CommandFiles::new())?.value;
    let model = crate::mujoco::mjcf(&scene.rig, &scene.physics, &scene.solids, scene.start);
    output::result(model.trim_end())?;
    Ok(Exit::Done)
}
