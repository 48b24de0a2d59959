//! The playground: one folder for any static host, with the compiler, the simulator and the score as WebAssembly.

use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::{env, fs, io};

use thiserror::Error;

use crate::cargo::{NotStarted, cargo, target_directory};
use crate::standard_library::is_installed;
use crate::web::{self, WebError};

/// The file of the module in the folder.
pub(crate) const MODULE: &str = "vibrissa.wasm";
/// The target.
const TARGET: &str = "wasm32-unknown-unknown";
/// The profile. It has another name than the folder, because Cargo makes a folder for each profile.
const PROFILE: &str = "browser";
/// The environment variable with a folder that has the standard library, where rustup cannot fetch it.
const SYSROOT: &str = "VIBRISSA_WASM_SYSROOT";
/// Cargo's variable with the compiler's options for the target.
const OPTIONS: &str = "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS";

/// The playground cannot be built.
#[derive(Debug, Error)]
pub(crate) enum PlaygroundError {
    #[error(
        "the standard library for {TARGET} is not installed; run `rustup target add {TARGET}`, or set {SYSROOT} to a folder that has it"
    )]
    NoLibrary,
    #[error("cargo {arguments}: it failed ({status}); what it found is above")]
    Failed { arguments: String, status: ExitStatus },
    #[error("cannot copy {}: {source}", path.display())]
    Copy { path: PathBuf, source: io::Error },
    #[error(transparent)]
    Web(#[from] WebError),
    #[error(transparent)]
    NotStarted(#[from] NotStarted),
}

impl PlaygroundError {
    /// True if the standard library is missing, so that this machine cannot build it.
    pub(crate) fn may_be_left_out(&self) -> bool {
        matches!(self, Self::NoLibrary)
    }
}

/// Builds the folder. The result is its path.
pub(crate) fn build(root: &Path) -> Result<PathBuf, PlaygroundError> {
    // As a library of Rust it has tests. Only here it is a module.
    let arguments = [
        "rustc",
        "--package",
        "vibrissa-playground",
        "--lib",
        "--crate-type",
        "cdylib",
        "--profile",
        PROFILE,
        "--target",
        TARGET,
    ];
    let mut command = cargo(root, &arguments);
    // Increments would divide the crates into more units than the profile says.
    command.env("CARGO_INCREMENTAL", "0");
    match env::var_os(SYSROOT).filter(|folder| !folder.is_empty()) {
        Some(folder) => {
            // In Cargo's other form of the variable, options are separated by spaces, which a path may contain.
            let options = format!("--sysroot\u{1f}{}", root.join(folder).to_string_lossy());
            command.env("CARGO_ENCODED_RUSTFLAGS", options).env_remove(OPTIONS);
        }
        None if is_installed(TARGET) || env::var_os(OPTIONS).is_some() => {}
        None => return Err(PlaygroundError::NoLibrary),
    }
    let status = command.status().map_err(|source| NotStarted { program: "cargo", source })?;
    if !status.success() {
        return Err(PlaygroundError::Failed { arguments: arguments.join(" "), status });
    }
    let folder = folder(root);
    web::bundle_playground(root, &folder)?;
    let built = target_directory(root).join(TARGET).join(PROFILE).join("vibrissa_playground.wasm");
    fs::copy(&built, folder.join(MODULE)).map_err(|source| PlaygroundError::Copy { path: built, source })?;
    Ok(folder)
}

/// The folder of the playground.
pub(crate) fn folder(root: &Path) -> PathBuf {
    target_directory(root).join("playground")
}
