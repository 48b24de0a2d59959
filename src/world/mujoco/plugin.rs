//! MuJoCo's plugin for cables.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use mujoco_rs::wrappers::load_plugin_library;

use super::world::MujocoError;

/// The directory of the library that the program is linked with; a MuJoCo of the system has none that is known.
const DIRECTORY: &str = match option_env!("MUJOCO_DYNAMIC_LINK_DIR") {
    Some(directory) => directory,
    None => "",
};

/// Loads the plugin, once in a process.
pub(super) fn load_cable_plugin() -> Result<(), MujocoError> {
    static LOADED: OnceLock<()> = OnceLock::new();
    let path = plugin_in(Path::new(DIRECTORY))?;
    LOADED.get_or_init(|| {
        // What it refuses is the form of the path, which is that of the library, too.
        let _ = load_plugin_library(&path);
    });
    Ok(())
}

/// Where the plugin is. MuJoCo would end the process for one that is not there.
fn plugin_in(directory: &Path) -> Result<PathBuf, MujocoError> {
    let path = directory.join(format!("{DLL_PREFIX}elasticity{DLL_SUFFIX}"));
    if path.is_file() { Ok(path) } else { Err(MujocoError::NoPlugin { path }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plugin_that_is_not_there_is_told_with_what_to_do() {
        let error = plugin_in(Path::new("/nowhere")).map_err(|error| error.to_string());
        assert!(error.is_err_and(|text| text.contains("/nowhere/") && text.contains("cargo x setup")));
    }
}
