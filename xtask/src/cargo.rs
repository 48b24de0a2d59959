//! Cargo, run for the checkout.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, io};

/// A Cargo command in the checkout at `root`, by the same Cargo that runs this program.
pub(crate) fn cargo<A: AsRef<OsStr>>(root: &Path, arguments: &[A]) -> Command {
    let program = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root);
    command
}

/// The directory into which Cargo builds.
pub(crate) fn target_directory(root: &Path) -> PathBuf {
    target(root, env::var_os("CARGO_TARGET_DIR"))
}

/// A relative directory is one of the checkout, in which Cargo is run.
fn target(root: &Path, set: Option<OsString>) -> PathBuf {
    root.join(set.filter(|directory| !directory.is_empty()).unwrap_or_else(|| "target".into()))
}

/// A program could not be started.
#[derive(Debug, thiserror::Error)]
#[error("`{program}` cannot be run: {source}.\nIt comes with Rust: look at what `{program} --version` says.")]
pub(crate) struct NotStarted {
    pub(crate) program: &'static str,
    pub(crate) source: io::Error,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_relative_target_directory_is_one_of_the_checkout() {
        let target = |set: Option<&str>| target(Path::new("/checkout"), set.map(OsString::from));
        assert_eq!(target(None), Path::new("/checkout/target"));
        assert_eq!(target(Some("")), Path::new("/checkout/target"));
        assert_eq!(target(Some("/shared")), Path::new("/shared"));
        assert_eq!(target(Some("mine")), Path::new("/checkout/mine"));
    }
}
