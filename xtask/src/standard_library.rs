//! The standard libraries of targets other than this machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use thiserror::Error;

use crate::cargo::{NotStarted, target_directory};

/// A script that builds the standard library for aarch64 into a directory. It may stand beside the checkout of a
/// machine where rustup cannot fetch the library.
const SCRIPT: &str = "../shared/aarch64/sysroot";

/// A standard library could not be built.
#[derive(Debug, Error)]
pub(crate) enum LibraryError {
    #[error(
        "{SCRIPT}: it failed ({0}); what it found is above. Or install the library: rustup target add aarch64-unknown-linux-gnu"
    )]
    Script(ExitStatus),
    #[error(transparent)]
    NotStarted(#[from] NotStarted),
}

/// True if the compiler finds a standard library, or at least its core, for the target.
pub(crate) fn is_installed(target: &str) -> bool {
    let folder = rustc(&["--print", "target-libdir", "--target", target]);
    let entries = folder.and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    entries.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with("libcore"))
}

/// The directory with a standard library for aarch64 that the script beside the checkout builds. `None` if there is no
/// such script. The library is built once per version of the compiler.
pub(crate) fn built(root: &Path) -> Result<Option<PathBuf>, LibraryError> {
    let script = root.join(SCRIPT);
    let Some(version) = rustc(&["--version"]).filter(|_| script.is_file()) else { return Ok(None) };
    let folder = target_directory(root).join("aarch64-sysroot").join(slug(&version));
    println!("      standard library for aarch64 by {SCRIPT}");
    let status = Command::new(&script).arg(&folder).status();
    let status = status.map_err(|source| NotStarted { program: SCRIPT, source })?;
    if status.success() { Ok(Some(folder)) } else { Err(LibraryError::Script(status)) }
}

/// The output of a run of the compiler, on one line.
fn rustc(arguments: &[&str]) -> Option<String> {
    let program = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(program).args(arguments).stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// A text as the name of a folder: its words joined by hyphens.
fn slug(text: &str) -> String {
    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '.');
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_compiler_has_its_own_folder() {
        assert_eq!(slug("rustc 1.95.0 (59807616e 2026-04-14)"), "rustc-1.95.0-59807616e-2026-04-14");
    }

    #[test]
    fn a_target_that_does_not_exist_is_not_installed() {
        assert!(!is_installed("pdp11-unknown-none"));
    }

    #[test]
    fn without_a_script_nothing_is_built() {
        assert!(built(Path::new("/nonexistent/checkout")).is_ok_and(|folder| folder.is_none()));
    }
}
