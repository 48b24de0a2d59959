//! Cargo, run for the checkout.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;
use std::{env, io};

/// A Cargo command in the checkout at `root`, by the same Cargo that runs this program.
pub(crate) fn cargo<A: AsRef<OsStr>>(root: &Path, arguments: &[A]) -> Command {
    let program = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root);
    command
}

/// A program could not be started.
#[derive(Debug, thiserror::Error)]
#[error("`{program}` cannot be run: {source}.\nIt comes with Rust: look at what `{program} --version` says.")]
pub(crate) struct NotStarted {
    pub(crate) program: &'static str,
    pub(crate) source: io::Error,
}
