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
const PACKAGES: [&str; 2] = ["gymnasium>=1.0", "pytest>=8"];

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

/// Builds the wheel, installs it into a fresh virtual environment, and runs its tests there.
pub(crate) fn test(root: &Path) -> Result<(), PythonError> {
    let target = target_directory(root);
    let folder = target.join("python");
    let maturin = maturin(&folder)?;
    let wheels = folder.join("wheels");
    clear(&wheels)?;
    let mut build = Command::new(&maturin);
    build
        .args(["build", "--quiet", "--profile", "dev", "--manifest-path", "crates/python/Cargo.toml", "--out"])
        .arg(&wheels);
    build.args(["--interpreter", "python3"]).current_dir(root).env("CARGO", workspace_cargo(&folder)?);
    succeed(build, PythonError::NotBuilt)?;
    let wheel = wheel_in(&wheels).ok_or(PythonError::NotBuilt)?;

    let environment = folder.join("environment");
    clear(&environment)?;
    let python = make_environment(&environment)?;
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

/// The program maturin, installed into the target directory once.
fn maturin(folder: &Path) -> Result<PathBuf, PythonError> {
    let tools = folder.join("tools");
    let program = tools.join("bin/maturin");
    let version = Command::new(&program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !version.is_ok_and(|status| status.success()) {
        clear(&tools)?;
        let python = make_environment(&tools)?;
        install(&python, [OsStr::new(MATURIN)])?;
    }
    Ok(program)
}

/// A script that stands for Cargo. maturin builds a package alone, whose dependencies have fewer features than in the
/// workspace, so that all of them would be compiled once more. The script builds the package with the workspace, with the
/// dependencies of the tests.
fn workspace_cargo(folder: &Path) -> Result<PathBuf, PythonError> {
    let path = folder.join("cargo");
    let cargo = env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let script = format!(
        "#!/bin/sh\ncase \"$1\" in\nrustc) exec '{cargo}' build --workspace --lib --bins --examples --message-format \
         json-render-diagnostics ;;\n*) exec '{cargo}' \"$@\" ;;\nesac\n"
    );
    let disk = |source| PythonError::Disk { action: "write", path: path.clone(), source };
    fs::write(&path, script).map_err(disk)?;
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).map_err(disk)?;
    Ok(path)
}

/// Makes a virtual environment and gives its Python.
fn make_environment(folder: &Path) -> Result<PathBuf, PythonError> {
    let mut command = Command::new("python3");
    command.args(["-m", "venv"]).arg(folder);
    succeed(command, PythonError::NoEnvironment)?;
    Ok(folder.join("bin/python"))
}

/// Installs packages by pip, with the settings of the user.
fn install<'a>(python: &Path, packages: impl IntoIterator<Item = &'a OsStr>) -> Result<(), PythonError> {
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
