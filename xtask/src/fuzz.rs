//! Mutated and generated policies in great number, on a stable compiler.

use std::path::Path;
use std::process::ExitStatus;

use thiserror::Error;

use crate::cargo::{NotStarted, cargo};

/// Why fuzzing ended.
#[derive(Debug, Error)]
pub(crate) enum FuzzError {
    #[error("fuzzing ended ({0}); what it found is above. Make what it found a fixture of the tests, with the fix")]
    Failed(ExitStatus),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// Tries some policies and prints what became of them.
pub(crate) fn fuzz(root: &Path, texts: u64) -> Result<(), FuzzError> {
    let test = ["test", "--release", "--no-default-features", "--package", "vibrissa", "--test", "policy_robustness"];
    let run = ["as_many_policies", "--", "--ignored", "--nocapture"];
    let mut command = cargo(root, &[&test[..], &run[..]].concat());
    let status = command.env("FUZZ_TEXTS", texts.to_string()).status();
    let status = status.map_err(|source| NotStarted { program: "cargo", source })?;
    if status.success() { Ok(()) } else { Err(FuzzError::Failed(status)) }
}
