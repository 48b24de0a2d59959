//! The crate of the robot: its dependencies, and the targets that it builds for.

use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};

use thiserror::Error;

use crate::cargo::{NotStarted, cargo};

/// The package.
const PACKAGE: &str = "vibrissa-runtime";
/// The direct dependencies that it may have. Each must build for small targets and need no system library.
const ALLOWED: [&str; 8] = ["biquad", "libm", "nalgebra", "postcard", "serde", "sha2", "strsim", "thiserror"];
/// The targets that it must build for: the Raspberry Pi, and pages in a browser.
const TARGETS: [&str; 2] = ["aarch64-unknown-linux-gnu", "wasm32-unknown-unknown"];

/// A fault of the crate of the robot.
#[derive(Debug, Error)]
pub(crate) enum RuntimeError {
    #[error("{PACKAGE} depends on {}; allowed are {}. Put the code that needs it into the package vibrissa", .0.join(", "), ALLOWED.join(", "))]
    Dependencies(Vec<String>),
    #[error("cargo {arguments}: it failed ({status}); what it found is above")]
    Failed { arguments: String, status: ExitStatus },
    #[error(transparent)]
    NotStarted(#[from] NotStarted),
}

/// Compares the direct dependencies with the list, and checks the crate for every target whose standard library is installed.
pub(crate) fn check(root: &Path) -> Result<(), RuntimeError> {
    let arguments = ["tree", "--package", PACKAGE, "--edges", "normal", "--depth", "1", "--prefix", "none"];
    let output = run(cargo(root, &arguments).stdout(Stdio::piped()), &arguments)?;
    let unknown = not_allowed(&output);
    if !unknown.is_empty() {
        return Err(RuntimeError::Dependencies(unknown));
    }
    for target in TARGETS {
        if !is_installed(target) {
            println!("      left out: the standard library of {target} is not installed (rustup target add {target})");
            continue;
        }
        println!("      cargo check for {target}");
        let arguments = ["check", "--quiet", "--package", PACKAGE, "--target", target];
        run(&mut cargo(root, &arguments), &arguments)?;
    }
    Ok(())
}

/// The packages of a tree, but for the first and those that are allowed.
fn not_allowed(tree: &str) -> Vec<String> {
    let names = tree.lines().skip(1).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| !ALLOWED.contains(name)).map(str::to_owned).collect()
}

/// True if the compiler finds a standard library for the target.
fn is_installed(target: &str) -> bool {
    let arguments = ["--print", "target-libdir", "--target", target];
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).args(arguments).stderr(Stdio::null()).output();
    let folder = output.ok().map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    entries.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with("libstd"))
}

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
