//! Everything that a tag publishes: built, checked as its users install it, and listed with sizes and hashes.

mod error;
mod installed;
mod listing;
mod program;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;
use std::{env, fs};

use crate::cargo::{NotStarted, cargo, target_directory};
use crate::pack::{self, copy, disk};
use crate::python::{self, Build};
use crate::setup::{self, Options};
use crate::{book, pi, playground};

pub(crate) use error::ReleaseError;

/// The version. All packages of the workspace have the same one.
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// The tool that packs an extension of VS Code.
const VSCE: &str = "@vscode/vsce@3";

/// Where files come from and go to.
struct Places<'a> {
    root: &'a Path,
    target: PathBuf,
    /// The folder of the released files.
    folder: PathBuf,
    /// What is prepared for them.
    staging: PathBuf,
}

impl Places<'_> {
    /// Copies a file to the released ones.
    fn add(&self, file: &Path) -> Result<(), ReleaseError> {
        Ok(copy(file, &self.folder.join(file.file_name().unwrap_or_default()))?)
    }
}

/// A step: what it makes, and how.
type Step = (&'static str, fn(&Places) -> Result<(), ReleaseError>);

/// The steps, in order. The checks install what the others have made.
const STEPS: [Step; 8] = [
    ("the program for this computer, with MuJoCo", program::native),
    ("the wheel for Python", wheel),
    ("the program for aarch64, without MuJoCo", program::aarch64),
    ("the robot's program for aarch64, as an archive and a Debian package", robot),
    ("the book", book),
    ("the extension for VS Code", extension),
    ("the packages for Cargo", crates),
    ("checks of the files as a user installs them", installed::check),
];

/// Builds, checks and lists what a tag publishes. The result is the folder.
pub(crate) fn release(root: &Path) -> Result<PathBuf, ReleaseError> {
    setup::setup(root, &Options::default())?;
    let target = target_directory(root);
    let places = Places { root, folder: target.join("release-files"), staging: target.join("release-staging"), target };
    for folder in [&places.folder, &places.staging] {
        pack::clear(folder)?;
    }
    for (number, (name, make)) in STEPS.iter().enumerate() {
        println!("[{}/{}] {name}", number + 1, STEPS.len());
        let start = Instant::now();
        make(&places)?;
        println!("      {} s", start.elapsed().as_secs());
    }
    fs::remove_dir_all(&places.staging).map_err(disk("clear", &places.staging))?;
    print!("{}", listing::write(&places.folder)?);
    Ok(places.folder)
}

/// Builds the wheel from the artifacts of the program.
fn wheel(places: &Places) -> Result<(), ReleaseError> {
    places.add(&python::build(places.root, &places.target.join("python"), Build::Release)?)
}

fn robot(places: &Places) -> Result<(), ReleaseError> {
    pi::pack(places.root)?.iter().try_for_each(|file| places.add(file))
}

/// Builds the book, with the playground where its standard library is there.
fn book(places: &Places) -> Result<(), ReleaseError> {
    match playground::build(places.root) {
        Ok(_) => {}
        Err(error) if error.may_be_left_out() => println!("      without the playground: {error}"),
        Err(error) => return Err(error.into()),
    }
    let page = book::build(places.root)?;
    let name = format!("vibrissa-book-{VERSION}");
    copy(page.parent().unwrap_or(&page), &places.staging.join(&name))?;
    pack::archive(&places.staging, &name, &places.folder)?;
    Ok(())
}

/// Packs the extension in a copy of its folder, so that the checkout stays as it is.
fn extension(places: &Places) -> Result<(), ReleaseError> {
    let folder = places.staging.join("extension");
    for name in ["README.md", "extension.js", "language-configuration.json", "package.json", "syntaxes"] {
        copy(&places.root.join("editors/vscode").join(name), &folder.join(name))?;
    }
    copy(&places.root.join("LICENSE-MIT"), &folder.join("LICENSE"))?;
    let file = places.folder.join(format!("vibrissa-fsm-{VERSION}.vsix"));
    let run = |arguments: &[&str]| {
        let mut command = Command::new("npx");
        command.args(arguments).current_dir(&folder).stdout(Stdio::null());
        succeed(command, "npx")
    };
    let install = Command::new("npm")
        .args(["install", "--silent", "--no-package-lock", "--omit=dev"])
        .current_dir(&folder)
        .stdin(Stdio::null())
        .status()
        .map_err(|source| NotStarted { program: "npm", source })?;
    if !install.success() {
        return Err(ReleaseError::Failed { command: "npm install".to_owned(), status: install });
    }
    run(&["--yes", VSCE, "package", "--allow-missing-repository", "--out", &file.to_string_lossy()])
}

/// Packs the sources of each crate. Cargo refuses files that differ from the commit.
fn crates(places: &Places) -> Result<(), ReleaseError> {
    let mut command = cargo(places.root, &["package", "--quiet", "--workspace", "--no-verify", "--exclude", "xtask"]);
    // Warnings of missing addresses: the project has none yet.
    command.stdin(Stdio::null());
    succeed(command, "cargo")?;
    let packed = places.target.join("package");
    let entries = fs::read_dir(&packed).map_err(disk("read", &packed))?;
    for entry in entries.flatten() {
        if entry.path().extension().is_some_and(|end| end == "crate") {
            places.add(&entry.path())?;
        }
    }
    Ok(())
}

/// Runs a command that shows its own errors.
fn succeed(mut command: Command, program: &'static str) -> Result<(), ReleaseError> {
    let status = command.status().map_err(|source| NotStarted { program, source })?;
    if status.success() {
        return Ok(());
    }
    let words: Vec<_> = command.get_args().map(|word| word.to_string_lossy()).collect();
    Err(ReleaseError::Failed { command: format!("{program} {}", words.join(" ")), status })
}

/// The name of this computer's kind, in names of files.
fn host() -> String {
    format!("{}-{}", env::consts::ARCH, env::consts::OS)
}
