//! MuJoCo's library and its plugin for cables in the checkout.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::hash::sha256;
use crate::platform::{MUJOCO_VERSION, Platform};
use crate::stamp::Stamp;
use crate::wheel::{self, WheelError};

/// How to set up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Options {
    /// Fetch the library even if it is there.
    pub(crate) force: bool,
    /// Take the library from this wheel, without a network.
    pub(crate) wheel: Option<PathBuf>,
}

/// Why set-up failed, and what to do.
#[derive(Debug, Error)]
pub(crate) enum SetupError {
    #[error(
        "MuJoCo {MUJOCO_VERSION} is not published as a wheel for {os} on {arch}.\n\
         It is for Linux with glibc (x86_64, aarch64) and for macOS (aarch64). Everything but the MuJoCo world works \
         without it: build with `--no-default-features`."
    )]
    NoPlatform { os: &'static str, arch: &'static str },
    #[error(transparent)]
    Wheel(#[from] WheelError),
    #[error("cannot {action} {path}: {source}.\nLook at the permissions and at the free space there.")]
    Disk { action: &'static str, path: PathBuf, source: io::Error },
}

/// Where things are within the checkout's `.mujoco`.
struct Store {
    directory: PathBuf,
    lib: PathBuf,
    staging: PathBuf,
}

impl Store {
    fn new(root: &Path) -> Self {
        let directory = root.join(".mujoco");
        Self { lib: directory.join("lib"), staging: directory.join("staging"), directory }
    }
}

const STAMP: &str = "stamp";

/// Makes sure that the checkout at `root` holds MuJoCo's library and the plugin, whole and of the right version.
///
/// Both are prepared aside and renamed into place, so that no part of them ever stands where builds look.
pub(crate) fn setup(root: &Path, options: &Options) -> Result<(), SetupError> {
    let (os, arch) = Platform::host();
    let platform = Platform::find(os, arch).ok_or(SetupError::NoPlatform { os, arch })?;
    let store = Store::new(root);
    fs::create_dir_all(&store.directory).map_err(disk("create", &store.directory))?;
    let _lock = lock(&store.directory.join("lock"))?;

    if !options.force && is_ready(platform, &store.lib) {
        println!("MuJoCo {MUJOCO_VERSION} is set up in .mujoco/lib.");
        return Ok(());
    }
    clear(&store.staging)?;
    let result = prepare(platform, options, &store.staging).and_then(|lib| install(&lib, &store));
    // What an interrupted run leaves is cleared by the next one; the error that matters is the first.
    let _ = fs::remove_dir_all(&store.staging);
    result?;
    println!("MuJoCo {MUJOCO_VERSION} is now in .mujoco/lib.");
    Ok(())
}

/// Two set-ups at once would use one staging directory. The lock goes with the file handle.
fn lock(path: &Path) -> Result<File, SetupError> {
    let file = File::create(path).map_err(disk("write", path))?;
    file.lock().map_err(disk("lock", path))?;
    Ok(file)
}

/// Holds if library and plugin are those that the stamp speaks of, and the stamp speaks of the pinned wheel.
fn is_ready(platform: &Platform, lib: &Path) -> bool {
    let Ok(Ok(stamp)) = fs::read_to_string(lib.join(STAMP)).map(|text| text.parse::<Stamp>()) else { return false };
    stamp.mujoco_version == MUJOCO_VERSION
        && stamp.wheel_sha256 == platform.wheel_sha256
        && [
            (platform.library, &stamp.library_sha256),
            (platform.link_name, &stamp.library_sha256),
            (platform.plugin, &stamp.plugin_sha256),
        ]
        .into_iter()
        .all(|(name, expected)| sha256(&lib.join(name)).is_ok_and(|hash| hash == *expected))
}

/// Fills a library directory within `staging`, and gives its path.
fn prepare(platform: &Platform, options: &Options, staging: &Path) -> Result<PathBuf, SetupError> {
    let lib = staging.join("lib");
    fs::create_dir_all(&lib).map_err(disk("create", &lib))?;
    let wheel = if let Some(wheel) = &options.wheel {
        wheel.clone()
    } else {
        let requirements = staging.join("requirements.txt");
        fs::write(&requirements, platform.requirement()).map_err(disk("write", &requirements))?;
        wheel::fetch(platform, &requirements, staging)?
    };
    wheel::verify(platform, &wheel)?;

    let [library, plugin] = [platform.library, platform.plugin].map(|name| lib.join(name));
    wheel::unpack(&wheel, &platform.library_in_wheel(), &library)?;
    wheel::unpack(&wheel, &platform.plugin_in_wheel(), &plugin)?;
    let link = lib.join(platform.link_name);
    fs::hard_link(&library, &link).map_err(disk("link", &link))?;
    let stamp = Stamp {
        mujoco_version: MUJOCO_VERSION.to_owned(),
        wheel_sha256: platform.wheel_sha256.to_owned(),
        library_sha256: sha256(&library).map_err(disk("read", &library))?,
        plugin_sha256: sha256(&plugin).map_err(disk("read", &plugin))?,
    };
    let stamp_path = lib.join(STAMP);
    fs::write(&stamp_path, stamp.to_string()).map_err(disk("write", &stamp_path))?;
    Ok(lib)
}

/// Puts a prepared library directory in the place of the one that is there.
fn install(prepared: &Path, store: &Store) -> Result<(), SetupError> {
    if store.lib.exists() {
        fs::rename(&store.lib, store.staging.join("old")).map_err(disk("replace", &store.lib))?;
    }
    fs::rename(prepared, &store.lib).map_err(disk("write", &store.lib))
}

fn clear(directory: &Path) -> Result<(), SetupError> {
    if directory.exists() { fs::remove_dir_all(directory).map_err(disk("clear", directory)) } else { Ok(()) }
}

fn disk(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> SetupError {
    let path = path.to_path_buf();
    move |source| SetupError::Disk { action, path, source }
}
