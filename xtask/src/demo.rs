//! The main job, from a fresh clone to a picture.

use std::path::Path;
use std::process::ExitCode;

use thiserror::Error;

use crate::cargo::{NotStarted, cargo};
use crate::setup::{self, Options, SetupError};

/// Why the demonstration did not run.
#[derive(Debug, Error)]
pub(crate) enum DemoError {
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// Sets up, builds in release, and runs the disk scenario; the exit status is the scenario's, or the build's.
pub(crate) fn demo(root: &Path) -> Result<ExitCode, DemoError> {
    setup::setup(root, &Options::default())?;
    println!("Building in release: a minute or two the first time.");
    let run = ["run", "--release", "--package", "vibrissa", "--", "run", "scenarios/disk.yaml", "--out", "out/demo"];
    let status = cargo(root, &run).status().map_err(|source| NotStarted { program: "cargo", source })?;
    // A program ended by a signal has no code.
    let code = status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(3);
    Ok(ExitCode::from(code))
}
