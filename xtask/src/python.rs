//! The Python package: its wheel, and its tests in a fresh virtual environment.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use thiserror::Error;

use crate::cargo::target_directory;
use crate::platform::MUJOCO_VERSION;

/// The release of maturin that builds the wheel.
const MATURIN: &str = "maturin>=1.9.4,<2";
/// What the tests need besides the wheel.
const PACKAGES: [&str; 5] = ["gymnasium>=1.0", "ipykernel>=6", "matplotlib>=3.8", "nbclient>=0.10", "pytest>=8"];

/// Why the package was not built or its tests failed, and what to do.
#[derive(Debug, Error)]
pub(crate) enum PythonError {
    #[error(
        "`python3` cannot make a virtual environment. Install its module `venv` (Debian, Ubuntu: `apt install python3-venv`)"
    )]
    NoEnvironment,
    #[error(
        "pip did not install {0}; what it said is above. Look at the network and pip's own settings (`python3 -m pip config list`)"
    )]
    NotInstalled(String),
    #[error("the wheel was not built; what maturin said is above")]
    NotBuilt,
    #[error("the tests of the Python package failed; what they found is above. Run them alone:\n  cargo x python")]
    Failed,
    #[error("`{program}` cannot be run: {source}")]
    NotStarted { program: String, source: io::Error },
    #[error("cannot {action} {}: {source}", path.display())]
    Disk { action: &'static str, path: PathBuf, source: io::Error },
}

/// For what a wheel is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Build {
    /// With what the tests of the workspace are built from.
    Tests,
    /// With the released program.
    Release,
}

/// What Cargo builds for a release: the program and the library of the wheel, with the same features.
pub(crate) const RELEASED: [&str; 5] = ["--release", "--package", "vibrissa", "--package", "vibrissa-python"];
/// What Cargo builds for the tests.
const TESTED: [&str; 4] = ["--workspace", "--lib", "--bins", "--examples"];

/// Builds the wheel, installs it into a fresh virtual environment, and runs its tests there.
pub(crate) fn test(root: &Path) -> Result<(), PythonError> {
    let target = target_directory(root);
    let folder = target.join("python");
    let wheel = build(root, &folder, Build::Tests)?;
    let python = environment(&folder.join("environment"))?;
    let all = || PACKAGES.map(OsStr::new).into_iter().chain([wheel.as_os_str()]);
    install(&python, all())?;
    // Only its library is needed, not what its viewer depends on.
    let mujoco = format!("mujoco=={MUJOCO_VERSION}");
    install(&python, [OsStr::new("--no-deps"), OsStr::new(&mujoco)])?;

    let mut tests = Command::new(&python);
    tests.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider", "crates/python/tests"]).current_dir(root);
    tests.env("PYTHONDONTWRITEBYTECODE", "1").env("VIBRISSA_PROGRAM", target.join("debug/vibrissa"));
    succeed(tests, PythonError::Failed)
}

/// Builds the wheel in a folder, and gives its path.
pub(crate) fn build(root: &Path, folder: &Path, build: Build) -> Result<PathBuf, PythonError> {
    let maturin = tool(&folder.join("tools"), MATURIN, "maturin")?;
    let wheels = folder.join("wheels");
    clear(&wheels)?;
    let (profile, built): (&str, &[&str]) = match build {
        Build::Tests => ("dev", &TESTED),
        Build::Release => ("release", &RELEASED),
    };
    let mut command = Command::new(&maturin);
    command.args(["build", "--quiet", "--profile", profile, "--manifest-path", "crates/python/Cargo.toml", "--out"]);
    command.arg(&wheels).args(["--interpreter", "python3"]).current_dir(root);
    command.env("CARGO", workspace_cargo(folder, built)?);
    succeed(command, PythonError::NotBuilt)?;
    wheel_in(&wheels).ok_or(PythonError::NotBuilt)
}

/// A program that pip installs into a folder once.
pub(crate) fn tool(folder: &Path, requirement: &str, name: &str) -> Result<PathBuf, PythonError> {
    let program = folder.join("bin").join(name);
    let version = Command::new(&program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !version.is_ok_and(|status| status.success()) {
        install(&environment(folder)?, [OsStr::new(requirement)])?;
    }
    Ok(program)
}

/// A script that stands for Cargo. maturin builds a package alone, whose dependencies have fewer features than in the
/// workspace, so that all of them would be compiled once more. The script builds the package with the workspace, with the
/// dependencies of the tests.
fn workspace_cargo(folder: &Path, built: &[&str]) -> Result<PathBuf, PythonError> {
    let path = folder.join("cargo");
    let cargo = env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let script = format!(
        "#!/bin/sh\ncase \"$1\" in\nrustc) exec '{cargo}' build {} --message-format json-render-diagnostics ;;\n\
         *) exec '{cargo}' \"$@\" ;;\nesac\n",
        built.join(" ")
    );
    let disk = |source| PythonError::Disk { action: "write", path: path.clone(), source };
    fs::write(&path, script).map_err(disk)?;
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).map_err(disk)?;
    Ok(path)
}

/// Makes a fresh virtual environment and gives its Python.
pub(crate) fn environment(folder: &Path) -> Result<PathBuf, PythonError> {
    clear(folder)?;
    let mut command = Command::new("python3");
    command.args(["-m", "venv"]).arg(folder);
    succeed(command, PythonError::NoEnvironment)?;
    Ok(folder.join("bin/python"))
}

/// Installs packages by pip, with the settings of the user.
pub(crate) fn install<'a>(python: &Path, packages: impl IntoIterator<Item = &'a OsStr>) -> Result<(), PythonError> {
    let packages: Vec<_> = packages.into_iter().collect();
    let names: Vec<_> = packages.iter().map(|name| name.to_string_lossy()).collect();
    let failed = PythonError::NotInstalled(names.join(" "));
    let mut command = Command::new(python);
    command.args(["-m", "pip", "--disable-pip-version-check", "--no-input", "install", "--quiet"]).args(&packages);
    succeed(command, failed)
}

fn wheel_in(folder: &Path) -> Option<PathBuf> {
    let files = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    files.into_iter().find(|path| path.extension().is_some_and(|end| end == "whl"))
}

/// Removes a folder.
fn clear(folder: &Path) -> Result<(), PythonError> {
    let disk = |source| PythonError::Disk { action: "clear", path: folder.to_owned(), source };
    if folder.exists() { fs::remove_dir_all(folder).map_err(disk) } else { Ok(()) }
}

fn succeed(mut command: Command, failed: PythonError) -> Result<(), PythonError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let status = command.stdin(Stdio::null()).status();
    let status = status.map_err(|source| PythonError::NotStarted { program, source })?;
    if status.success() { Ok(()) } else { Err(failed) }
}
