//! The pages of measured figures, `docs/results`, each made of the output of commands of the program.

mod inputs;
mod kept;
mod mismatch;
mod pages;
mod program;
mod readme;
mod real;
mod reproduction;
mod stale;
mod stamp;
mod sums;
mod table;
mod tables;
mod verdicts;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::thread;
use std::time::Instant;

use thiserror::Error;

use crate::cargo::NotStarted;
use crate::setup::SetupError;
pub(crate) use inputs::BENCH;
use kept::Kept;
pub(crate) use pages::FAMILIES;
use pages::{Content, PAGES, Page};
pub(crate) use program::{build, output};
pub(crate) use stale::{StaleError, changes_of, check, renew};
use stamp::{Stamp, StampError};
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
    /// The names of the pages; without any, those that take less than two minutes, or all that are stale.
    pub(crate) names: Vec<String>,
    /// Only pages whose stamps differ.
    pub(crate) stale: bool,
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
    #[error("`{}` contains another text of {file} than the checkout. Build it from the checkout", path.display())]
    OtherProgram { path: PathBuf, file: String },
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
    #[error("the picture was not written to {}: {source}", path.display())]
    NoPicture { path: PathBuf, source: io::Error },
    #[error("cannot write {}: {source}; look at its permissions", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("page `{page}`: while it was made, this changed: {changed}. Run the command again")]
    Changed { page: &'static str, changed: String },
    #[error("these pages were not made:\n  {0}")]
    Unmade(String),
    #[error(transparent)]
    Stamp(#[from] StampError),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// Runs the commands of the pages that are selected, and writes each page.
pub(crate) fn write(root: &Path, selection: &Selection) -> Result<(), ResultsError> {
    if selection.stale {
        return renew(root, selection);
    }
    let pages = selected(&selection.names)?;
    let press = Press::new(root, selection.program.as_deref())?;
    for page in pages {
        press.make(page, false)?;
    }
    write_readme(root)
}

/// What all pages of a call have in common.
struct Press<'a> {
    root: &'a Path,
    kept: Kept<'a>,
    /// The commit of the program.
    commit: String,
    machine: String,
}

impl<'a> Press<'a> {
    /// With the given program, or one that is built.
    fn new(root: &'a Path, program: Option<&Path>) -> Result<Self, ResultsError> {
        // Before anything runs, so that the state of the checkout is that of the program.
        let (commit, machine) = (commit(root)?, machine());
        let kept = Kept::of(root, program::of_checkout(root, program)?)?;
        Ok(Self { root, kept, commit, machine })
    }

    /// Makes a page. Outputs of earlier calls may be `reused`.
    fn make(&self, page: &Page, reused: bool) -> Result<(), ResultsError> {
        eprintln!("{}: {}", page.name, page.about);
        let start = Instant::now();
        let stamp = Stamp::of(self.root, page)?;
        let text = match page.content {
            Content::Tables(body) => {
                let outputs = page.commands.iter().map(|command| self.kept.output(command, reused));
                let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
                let body = body(&outputs).map_err(|source| ResultsError::Key { page: page.name, source })?;
                head(page, &self.commit, &self.machine) + &body + "\n"
            }
            // It takes seconds, and the file may be gone.
            Content::Picture { command, made, .. } => {
                self.kept.output(command, false)?;
                let path = self.kept.folder_of(command)?.join(made);
                fs::read_to_string(&path)
                    .map_err(|source| ResultsError::NoPicture { path, source })?
                    .trim_end()
                    .to_owned()
                    + "\n"
            }
        };
        let changed = Stamp::of(self.root, page)?.changes(&stamp);
        if !changed.is_empty() {
            return Err(ResultsError::Changed { page: page.name, changed: changed.join(", ") });
        }
        let path = self.root.join(page.path());
        let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
        let written = folder.and_then(|()| fs::write(&path, text + &stamp.text()));
        written.map_err(|source| ResultsError::Write { path: path.clone(), source })?;
        eprintln!("      {} after {} s", path.display(), start.elapsed().as_secs());
        Ok(())
    }
}

/// README.md with the figures of the pages in its table, and its present text.
fn readme(root: &Path) -> Result<[String; 2], ResultsError> {
    let text = |name: String| fs::read_to_string(root.join(name)).unwrap_or_default();
    let page = |name: &str| text(format!("{FOLDER}/{name}.md"));
    let present = text("README.md".to_owned());
    let made = readme::with_figures(&present, &page("bench"), &page("real")).ok_or(ResultsError::NoTable)?;
    Ok([made, present])
}

/// Writes the figures of the pages into the table of README.md.
fn write_readme(root: &Path) -> Result<(), ResultsError> {
    let path = root.join("README.md");
    let [readme, _] = readme(root)?;
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
            "\n    vibrissa study timing --ideal --repeats 3 --json\n    vibrissa study timing --ideal --repeats 3 --world quasistatic --json\n"
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
        assert!(names(&["bnech"]).is_err_and(|error| error.to_string().contains("calibration, bench, timing")));
    }

    #[test]
    fn the_model_of_the_processor_is_read() {
        assert_eq!(model("processor: 0\nmodel name\t: AMD EPYC \n").as_deref(), Some("AMD EPYC"));
        assert_eq!(model("Hardware: BCM2711\n"), None);
    }
}
