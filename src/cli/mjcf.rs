//! `vibrissa mjcf`

use super::arguments::MjcfArguments;
use super::exit::{Exit, Failure};
use super::{input, output};

pub(super) fn mjcf(arguments: &MjcfArguments) -> Result<Exit, Failure> {
    let scene = input::scenario(&arguments.scenario)?.value;
    let model = crate::scene::mjcf(&scene.rig, Some(&scene.object), scene.start)
        .map_err(|cause| Failure::Solid { scenario: arguments.scenario.clone(), cause })?;
    output::result(model.trim_end())?;
    Ok(Exit::Done)
}
