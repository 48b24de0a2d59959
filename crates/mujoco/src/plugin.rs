//! MuJoCo's cable plugin.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use super::library::{loader_message, open, stated_folder};

/// The directory of the library that the program was linked with. `None` for a system-wide MuJoCo.
const DIRECTORY: Option<&str> = option_env!("MUJOCO_DYNAMIC_LINK_DIR");

/// The reason why the cable plugin is not available.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum PluginError {
    /// The program is linked with a system-wide MuJoCo, whose directory is unknown.
    #[error(
        "this program uses the system's MuJoCo, and the directory of its cable plugin is not known: build the program with \
         MUJOCO_DYNAMIC_LINK_DIR set to the directory of MuJoCo's library and put {file} there, \
         or leave `preset: peer_cable` out of the rig"
    )]
    NoDirectory {
        /// The file name of the plugin.
        file: String,
    },
    /// The file does not exist.
    #[error(
        "MuJoCo's cable plugin is missing ({}): run `cargo x setup`, or leave `preset: peer_cable` out of the rig",
        path.display()
    )]
    NoPlugin {
        /// The expected path.
        path: PathBuf,
    },
    /// The file exists but cannot be loaded.
    #[error(
        "MuJoCo's cable plugin cannot be loaded ({cause}): run `cargo x setup`, or leave `preset: peer_cable` out of the rig"
    )]
    Damaged {
        /// The message of the loader.
        cause: String,
    },
}

/// Loads the plugin once per process. MuJoCo's own loader would end the process on failure.
///
/// # Errors
/// [`PluginError`] if the plugin is not in the directory of the library, if this directory is unknown, or if loading
/// fails.
pub(super) fn load_cable_plugin() -> Result<(), PluginError> {
    static LOADED: OnceLock<Result<(), String>> = OnceLock::new();
    let stated = stated_folder();
    // MuJoCo's Python package has its plugins in a folder of their own.
    let own = stated.map(|folder| folder.join("plugin")).filter(|folder| folder.is_dir());
    let directory = own.as_deref().or(stated).or(DIRECTORY.map(Path::new));
    let path = plugin_in(directory)?;
    let loaded = LOADED.get_or_init(|| open(&path).map(|_| ()).map_err(|cause| loader_message(&cause)));
    loaded.clone().map_err(|cause| PluginError::Damaged { cause })
}

/// Returns the path of the plugin. A missing file is reported here, because the loader's message is longer and less
/// specific.
fn plugin_in(directory: Option<&Path>) -> Result<PathBuf, PluginError> {
    let file = format!("{DLL_PREFIX}elasticity{DLL_SUFFIX}");
    let Some(directory) = directory.filter(|directory| !directory.as_os_str().is_empty()) else {
        return Err(PluginError::NoDirectory { file });
    };
    let path = directory.join(file);
    if path.is_file() { Ok(path) } else { Err(PluginError::NoPlugin { path }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plugin_that_is_not_there_is_reported_with_what_to_do() {
        let error = plugin_in(Some(Path::new("/nowhere"))).map_err(|error| error.to_string());
        assert!(error.is_err_and(|text| text.contains("/nowhere/") && text.contains("cargo x setup")));
    }

    #[test]
    fn with_a_mujoco_of_the_system_the_advice_is_another() {
        for directory in [None, Some(Path::new(""))] {
            let error = plugin_in(directory).map_err(|error| error.to_string());
            assert!(error.is_err_and(|text| text.contains("MUJOCO_DYNAMIC_LINK_DIR") && !text.contains("cargo x")));
        }
    }
}
