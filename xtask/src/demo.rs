//! The main job, from a fresh clone to a picture.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use thiserror::Error;

use crate::cargo::{NotStarted, cargo};
use crate::setup::{self, Options, SetupError};
use crate::sign_of_life::SignOfLife;

/// Why the demonstration did not run.
#[derive(Debug, Error)]
pub(crate) enum DemoError {
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// What to do when the demonstration has run.
const NEXT: &str = "Look at out/demo/disk.svg. Try next: cargo run --release -- run scenarios/box.yaml --out out/box";

/// Sets up, builds in release, and runs the disk scenario; the exit status is the scenario's, or the build's.
pub(crate) fn demo(root: &Path) -> Result<ExitCode, DemoError> {
    println!("[1/3] MuJoCo's library: a download of some megabytes the first time");
    {
        let _sign = SignOfLife::of("setting up");
        setup::setup(root, &Options::default())?;
    }
    println!("[2/3] Building in release: some minutes the first time, by the speed of the machine");
    let start = Instant::now();
    let built = {
        let _sign = SignOfLife::of("building; the last crate, vibrissa itself, takes longest");
        succeeds(root, &["build", "--release", "--package", "vibrissa"])?
    };
    if let Err(code) = built {
        return Ok(code);
    }
    println!("      built in {} s", start.elapsed().as_secs());
    println!("[3/3] Running scenarios/disk.yaml: a minute of simulated time, some seconds of yours");
    let run = ["run", "--quiet", "--release", "--package", "vibrissa", "--"];
    let ran = {
        let _sign = SignOfLife::of("running");
        succeeds(root, &[&run[..], &["run", "scenarios/disk.yaml", "--out", "out/demo"]].concat())?
    };
    if let Err(code) = ran {
        return Ok(code);
    }
    println!("\n{NEXT}");
    Ok(ExitCode::SUCCESS)
}

/// Runs Cargo; the exit status of one that fails.
fn succeeds(root: &Path, arguments: &[&str]) -> Result<Result<(), ExitCode>, NotStarted> {
    let status = cargo(root, arguments).status().map_err(|source| NotStarted { program: "cargo", source })?;
    if status.success() {
        return Ok(Ok(()));
    }
    // A program ended by a signal has no code.
    Ok(Err(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(3))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_to_try_next_is_there_to_be_tried() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
        let scenario = NEXT.split_whitespace().find(|word| word.starts_with("scenarios/"));
        assert!(scenario.is_some_and(|scenario| root.join(scenario).is_file()), "{NEXT}");
    }
}
