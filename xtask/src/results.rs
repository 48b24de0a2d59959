//! The pages of measured figures, `docs/results`, each made of the output of commands of the program.

mod mismatch;
mod pages;
mod readme;
mod reproduction;
mod sums;
mod table;
mod tables;
mod verdicts;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::thread;
use std::time::Instant;

use thiserror::Error;

use crate::cargo::{NotStarted, cargo};
use crate::json::Json;
use crate::setup::{self, Options, SetupError};
use crate::sign_of_life::SignOfLife;
pub(crate) use pages::FAMILIES;
use pages::{PAGES, Page};
pub(crate) use table::{NoKey, number, value};
pub(crate) use verdicts::{PageError, SIMULATORS, Verdicts, joined};

/// The folder of the pages.
pub(crate) const FOLDER: &str = "docs/results";
/// The files that the figures depend on. A commit that changes only other files, such as documentation, leaves them as they are.
const PROGRAM: [&str; 8] =
    ["src", "crates", "policies", "scenarios", "grammar", "build.rs", "Cargo.toml", "Cargo.lock"];

/// The pages to make, and the program to make them with.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub(crate) struct Selection {
    /// The names of the pages; without any, those that take less than two minutes.
    pub(crate) names: Vec<String>,
    /// A program that is there already, instead of one that is built.
    pub(crate) program: Option<PathBuf>,
}

/// A fault that leaves a page unmade.
#[derive(Debug, Error)]
pub(crate) enum ResultsError {
    #[error("there is no page `{0}`. The pages are: {names}", names = PAGES.map(|page| page.name).join(", "))]
    NoPage(String),
    #[error("the build failed ({0}); what Cargo found is above")]
    Build(ExitStatus),
    #[error("`{}` cannot be run: {source}. Name a program that is there with `--program FILE`", path.display())]
    Program { path: PathBuf, source: io::Error },
    #[error("`vibrissa {command}` failed ({status}); run it alone. It said:\n{said}")]
    Failed { command: String, status: ExitStatus, said: String },
    #[error("`vibrissa {0}` did not print JSON; run it alone and look at what it prints")]
    NoJson(String),
    #[error("page `{page}`: {source} in the output. Was it renamed? Correct xtask/src/results/tables.rs")]
    Key { page: &'static str, source: NoKey },
    #[error("git does not tell the commit of the program: {0}. Run this in a clone with its history")]
    Git(String),
    #[error("README.md has no table that begins with `| scene |`; restore it")]
    NoTable,
    #[error("cannot write {}: {source}; look at its permissions", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// Runs the commands of the pages that are selected, and writes each page.
pub(crate) fn write(root: &Path, selection: &Selection) -> Result<(), ResultsError> {
    let pages = selected(&selection.names)?;
    // Before anything runs, so that the state of the checkout is that of the program.
    let commit = commit(root)?;
    let machine = machine();
    if selection.program.is_none() {
        build(root)?;
    }
    for page in pages {
        eprintln!("{}: {}", page.name, page.about);
        let start = Instant::now();
        let outputs = page.commands.iter().map(|command| output(root, selection.program.as_deref(), command));
        let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
        let body = (page.body)(&outputs).map_err(|source| ResultsError::Key { page: page.name, source })?;
        let path = root.join(FOLDER).join(page.name).with_extension("md");
        let text = head(page, &commit, &machine) + &body;
        let written = fs::create_dir_all(root.join(FOLDER)).and_then(|()| fs::write(&path, text));
        written.map_err(|source| ResultsError::Write { path: path.clone(), source })?;
        eprintln!("      {} after {} s", path.display(), start.elapsed().as_secs());
    }
    write_readme(root)
}

/// Writes the figures of the pages into the table of README.md.
fn write_readme(root: &Path) -> Result<(), ResultsError> {
    let path = root.join("README.md");
    let page = |name: &str| fs::read_to_string(root.join(FOLDER).join(name)).unwrap_or_default();
    let readme = fs::read_to_string(&path).unwrap_or_default();
    let readme = readme::with_figures(&readme, &page("bench.md"), &page("mismatch.md")).ok_or(ResultsError::NoTable)?;
    fs::write(&path, readme).map_err(|source| ResultsError::Write { path, source })
}

/// The pages of these names, or all that are not slow.
fn selected(names: &[String]) -> Result<Vec<&'static Page>, ResultsError> {
    if names.is_empty() {
        return Ok(PAGES.iter().filter(|page| !page.is_slow).collect());
    }
    let page =
        |name: &String| PAGES.iter().find(|page| page.name == name).ok_or_else(|| ResultsError::NoPage(name.clone()));
    names.iter().map(page).collect()
}

/// Builds the program in release.
pub(crate) fn build(root: &Path) -> Result<(), ResultsError> {
    setup::setup(root, &Options::default())?;
    let _sign = SignOfLife::of("building; the last crate, vibrissa itself, takes longest");
    let mut build = cargo(root, &["build", "--release", "--package", "vibrissa"]);
    let status = build.status().map_err(|source| NotStarted { program: "cargo", source })?;
    if status.success() { Ok(()) } else { Err(ResultsError::Build(status)) }
}

/// The output of a command of the program.
pub(crate) fn output(root: &Path, program: Option<&Path>, command: &str) -> Result<Json, ResultsError> {
    let mut run = if let Some(path) = program {
        Command::new(path)
    } else {
        cargo(root, &["run", "--quiet", "--release", "--package", "vibrissa", "--"])
    };
    let path = program.unwrap_or(Path::new("cargo"));
    eprintln!("      vibrissa {command}");
    let output = {
        let _sign = SignOfLife::of("running");
        run.args(command.split_whitespace()).current_dir(root).stdin(Stdio::null()).output()
    };
    let output = output.map_err(|source| ResultsError::Program { path: path.to_owned(), source })?;
    // 1 says only that a run did not meet what was expected of it.
    if !matches!(output.status.code(), Some(0 | 1)) {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(ResultsError::Failed { command: command.to_owned(), status: output.status, said });
    }
    Json::read(&String::from_utf8_lossy(&output.stdout)).ok_or_else(|| ResultsError::NoJson(command.to_owned()))
}

/// The commit that last changed the program, its date, and whether there are changes that are not committed.
pub(crate) fn commit(root: &Path) -> Result<String, ResultsError> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).arg("--").args(PROGRAM).current_dir(root).output();
        let output = output.map_err(|error| ResultsError::Git(error.to_string()))?;
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        if output.status.success() { Ok(text) } else { Err(ResultsError::Git(said)) }
    };
    let last = git(&["log", "-1", "--abbrev=7", "--date=format:%Y-%m-%d", "--format=`%h` of %cd"])?;
    if last.is_empty() {
        return Err(ResultsError::Git("the history has no commit of it".to_owned()));
    }
    let is_dirty = !git(&["status", "--porcelain"])?.is_empty();
    Ok(if is_dirty { format!("{last}, with uncommitted changes") } else { last })
}

/// The processors of this machine, and how busy they are.
fn machine() -> String {
    let count = thread::available_parallelism().map_or(1, usize::from);
    let model = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| model(&text));
    let model = model.map(|model| format!(" ({model})")).unwrap_or_default();
    let load = fs::read_to_string("/proc/loadavg").ok().and_then(|text| Some(text.split_once(' ')?.0.to_owned()));
    let load = load.map(|load| format!(", with a load average of {load} at the start")).unwrap_or_default();
    format!("{count} processor{}{model}{load}", if count == 1 { "" } else { "s" })
}

/// The model of the first processor.
fn model(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// The beginning of a page.
fn head(page: &Page, commit: &str, machine: &str) -> String {
    let commands = page.commands.iter().fold(String::new(), |text, command| text + "    vibrissa " + command + "\n");
    let machine = if page.has_times { format!(" Times are of a machine with {machine}.") } else { String::new() };
    let Page { name, title, about, .. } = page;
    format!(
        "<!-- generated by cargo x results {name} -->\n\n# {title}\n\n{about} [Metrics](../metrics.md) defines the figures.\n\n\
         {commands}\nThe program is of commit {commit}.{machine} `cargo x results {name}` makes this page again.\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_begins_with_its_content_its_commands_and_the_commit() {
        let Ok(pages) = selected(&["timing".to_owned()]) else { panic!("there is a page of times") };
        let head = head(pages[0], "`abc1234` of 2026-01-02", "2 processors (X)");
        assert!(head.starts_with("<!-- generated by cargo x results timing -->\n\n# Run times\n\n"), "{head}");
        assert!(head.contains(
            "\n    vibrissa timing --repeats 3 --json\n    vibrissa timing --repeats 3 --world quasistatic --json\n"
        ));
        assert!(
            head.contains("commit `abc1234` of 2026-01-02. Times are of a machine with 2 processors (X)."),
            "{head}"
        );
    }

    #[test]
    fn slow_pages_are_made_only_if_they_are_named() {
        let names = |names: &[&str]| {
            let names: Vec<_> = names.iter().map(|&name| name.to_owned()).collect();
            selected(&names).map(|pages| pages.iter().map(|page| page.name).collect::<Vec<_>>())
        };
        assert!(names(&[]).is_ok_and(|names| names.contains(&"bench") && !names.contains(&"families")));
        assert_eq!(names(&["families"]).ok(), Some(vec!["families"]));
        assert!(names(&["bnech"]).is_err_and(|error| error.to_string().contains("bench, reproduction, friction")));
    }

    #[test]
    fn the_model_of_the_processor_is_read() {
        assert_eq!(model("processor: 0\nmodel name\t: AMD EPYC \n").as_deref(), Some("AMD EPYC"));
        assert_eq!(model("Hardware: BCM2711\n"), None);
    }
}
