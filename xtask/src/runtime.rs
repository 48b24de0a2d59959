//! The crate of the robot: its dependencies, and the targets that it builds for.

use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};

use thiserror::Error;

use crate::cargo::{NotStarted, cargo};
use crate::cross::{self, Cross, CrossError};
use crate::standard_library::is_installed;

/// The package.
const PACKAGE: &str = "vibrissa-runtime";
/// The direct dependencies that it may have. Each must build for small targets and need no system library.
const ALLOWED: [&str; 8] = ["biquad", "libm", "nalgebra", "postcard", "serde", "sha2", "strsim", "thiserror"];
/// The targets that packages must build for: pages in a browser for the runtime, the language, the
/// quasi-static simulator and the playground, and microcontrollers without an operating
/// system for the driver of the sensor. The Raspberry Pi has a check of its own.
const BUILDS: [(&str, &str); 5] = [
    (PACKAGE, "wasm32-unknown-unknown"),
    ("vibrissa-language", "wasm32-unknown-unknown"),
    ("vibrissa-world", "wasm32-unknown-unknown"),
    ("vibrissa-playground", "wasm32-unknown-unknown"),
    ("vibrissa-mlx90393", "riscv32imc-unknown-none-elf"),
];
/// Cargo's arguments for the tests on aarch64. It builds both packages at once, because their dependencies would have
/// other features one by one. An emulated hour, the statistics of many calibrations, and long searches and explorations of
/// a map take an emulated processor too long, and need no certain processor. That a map has the same bits is a test of its own.
///
/// Rustdoc would need the settings of the cross build too, and its examples are tested on this machine.
const ON_AARCH64: [&str; 23] = [
    "test",
    "--package",
    PACKAGE,
    "--package",
    "vibrissa-robot",
    "--no-default-features",
    "--features",
    "vibrissa-robot/emulation",
    "--lib",
    "--tests",
    "--target",
    cross::TARGET,
    "--",
    "--skip",
    "an_hour_",
    "--skip",
    "calibration::touch_tests::",
    "--skip",
    "a_route_is_at_most_half_longer_than_the_shortest_one",
    "--skip",
    "a_long_search_takes_many_ticks",
    "--skip",
    "exploring::",
];
/// Number of cases of every property, also of those with a number of their own. The code is the same as on this machine,
/// and an emulated processor takes twenty times as long.
const CASES: (&str, &str) = ("PROPTEST_CASES", "40");

/// A fault of the crate of the robot.
#[derive(Debug, Error)]
pub(crate) enum RuntimeError {
    #[error("{PACKAGE} depends on {}; allowed are {}. Put the code that needs it into the package vibrissa", .0.join(", "), ALLOWED.join(", "))]
    Dependencies(Vec<String>),
    #[error("cargo {arguments}: it failed ({status}); what it found is above")]
    Failed { arguments: String, status: ExitStatus },
    #[error(transparent)]
    Cross(#[from] CrossError),
    #[error(transparent)]
    NotStarted(#[from] NotStarted),
}

/// Compares the direct dependencies with the list, and checks packages for every target whose library is installed.
pub(crate) fn check(root: &Path) -> Result<(), RuntimeError> {
    let arguments = ["tree", "--package", PACKAGE, "--edges", "normal", "--depth", "1", "--prefix", "none"];
    let output = run(cargo(root, &arguments).stdout(Stdio::piped()), &arguments)?;
    let unknown = not_allowed(&output);
    if !unknown.is_empty() {
        return Err(RuntimeError::Dependencies(unknown));
    }
    for (package, target) in BUILDS {
        if !is_installed(target) {
            println!(
                "      left out: {package} for {target}, whose library is not installed (rustup target add {target})"
            );
            continue;
        }
        println!("      cargo check of {package} for {target}");
        let arguments = ["check", "--quiet", "--package", package, "--target", target];
        run(&mut cargo(root, &arguments), &arguments)?;
    }
    Ok(())
}

/// Runs tests on aarch64, under an emulator: those of the runtime, and those of the robot with emulated buses.
/// `environment` is a variable and its value.
pub(crate) fn test_on_aarch64(root: &Path, environment: (&str, &str)) -> Result<(), RuntimeError> {
    let cross = match Cross::find(root) {
        Ok(cross) => cross,
        Err(error) if error.may_be_left_out() => {
            println!("      left out: {error}");
            return Ok(());
        }
        Err(error) => return Err(error.into()),
    };
    println!("      cargo {}", ON_AARCH64.join(" "));
    let mut command = cargo(root, &ON_AARCH64);
    command.envs([environment, CASES]).stdout(Stdio::inherit());
    run(cross.set(&mut command), &ON_AARCH64)?;
    Ok(())
}

/// The packages of a tree, but for the first and those that are allowed.
fn not_allowed(tree: &str) -> Vec<String> {
    let names = tree.lines().skip(1).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| !ALLOWED.contains(name)).map(str::to_owned).collect()
}

/// Runs Cargo, and gives what it printed if that is piped.
fn run(command: &mut Command, arguments: &[&str]) -> Result<String, RuntimeError> {
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.map_err(|source| NotStarted { program: "cargo", source })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(RuntimeError::Failed { arguments: arguments.join(" "), status: output.status })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dependency_that_is_not_on_the_list_is_named() {
        let tree = "vibrissa-runtime v0.1.0 (/x)\nnalgebra v0.35.0\nclap v4.6.0\nserde v1.0.0 (*)\n";
        assert_eq!(not_allowed(tree), ["clap"]);
        assert!(not_allowed("vibrissa-runtime v0.1.0\n").is_empty());
    }
}
