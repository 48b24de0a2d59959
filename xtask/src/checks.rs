//! Every test and every lint.

use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, io};

use thiserror::Error;

use crate::book::{self, BookError};
use crate::cargo::{NotStarted, cargo, target_directory};
use crate::checkout::Checkout;
use crate::comments::{self, CommentsError};
use crate::commits::{self, CommitsError};
use crate::links::{self, LinkError};
use crate::prose::{self, ProseError};
use crate::python::{self, PythonError};
use crate::results::{self, StaleError};
use crate::runtime::{self, RuntimeError};
use crate::setup::{self, Options, SetupError};
use crate::web::{self, WebError};

/// One thing that must hold.
struct Check {
    title: &'static str,
    work: Work,
}

enum Work {
    Cargo(CargoRun),
    CoreIsFreeOfMujoco,
    Setup,
    Commits,
    Runtime,
    Aarch64,
    Prose,
    Links,
    Results,
    Book,
    Web,
    Browser,
    Examples,
    Python,
    CheckoutIsUntouched,
}

/// A Cargo command that must succeed.
struct CargoRun {
    environment: &'static [(&'static str, &'static str)],
    /// Separated by blanks.
    arguments: &'static str,
}

/// Why the checks stopped, and what to do.
#[derive(Debug, Error)]
pub(crate) enum CheckError {
    #[error("{title}: it failed ({status}); what it found is above. Run it alone:\n  {rerun}")]
    Failed { title: &'static str, status: ExitStatus, rerun: String },
    #[error(
        "mujoco-rs is among the core's dependencies: keep it behind the feature `sim`. What brings it in:\n  \
         cargo tree --no-default-features --invert mujoco-rs"
    )]
    CoreNeedsMujoco,
    #[error("there is no check {number}; their numbers are 1 to {count}", count = CHECKS.len())]
    NoSuchCheck { number: usize },
    #[error("the tests changed the checkout; let them write to a temporary directory only:\n  {0}")]
    LeftBehind(String),
    #[error("cannot list or start the examples: {0}")]
    Examples(io::Error),
    #[error(transparent)]
    Runtime(#[from] RuntimeError),
    #[error(transparent)]
    Prose(#[from] ProseError),
    #[error(transparent)]
    Comments(#[from] CommentsError),
    #[error(transparent)]
    Commits(#[from] CommitsError),
    #[error(transparent)]
    Links(#[from] LinkError),
    #[error(transparent)]
    Stale(#[from] StaleError),
    #[error(transparent)]
    Book(#[from] BookError),
    #[error(transparent)]
    Web(#[from] WebError),
    #[error(transparent)]
    Python(#[from] PythonError),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// The seed of the properties' random cases: whether a change lands must not hang on a fault that chance finds elsewhere.
/// `cargo test` by itself draws new cases each time.
const SAME_CASES: (&str, &str) = ("PROPTEST_RNG_SEED", "1");

/// In this order: what fails soonest comes first, and the core is compiled before there need be any MuJoCo. Its tests take too
/// long for each change, so they are among the nightly ones (.github/workflows/nightly.yml).
///
/// All of it is the `dev` profile. Dependencies are compiled for the tests and checked for clippy and documentation.
const CHECKS: [Check; 21] = [
    check("formatting", "fmt --all --check"),
    Check { title: "prose of the documentation and the doc comments", work: Work::Prose },
    Check { title: "links of the documentation", work: Work::Links },
    Check { title: "subjects of commits", work: Work::Commits },
    Check { title: "published figures", work: Work::Results },
    Check { title: "dependencies and targets of the runtime", work: Work::Runtime },
    Check { title: "no MuJoCo among the core's dependencies", work: Work::CoreIsFreeOfMujoco },
    check_in(
        // mujoco-rs's build script would stop at a directory that does not exist.
        &[("MUJOCO_DYNAMIC_LINK_DIR", "/nonexistent")],
        "lints of the core, without MuJoCo",
        // The Python package has no test of Cargo. But with it, dependencies have the features of the whole workspace.
        "clippy -p vibrissa -p vibrissa-text -p vibrissa-yaml -p vibrissa-language -p vibrissa-world -p vibrissa-mujoco -p vibrissa-lab -p vibrissa-python --no-default-features --all-targets -- --deny warnings",
    ),
    Check { title: "book", work: Work::Book },
    Check { title: "scripts of the pages", work: Work::Web },
    Check { title: "set-up", work: Work::Setup },
    check("lints", "clippy --workspace --all-targets -- --deny warnings"),
    check_in(&[SAME_CASES], "tests", "test --workspace"),
    Check { title: "tests of the runtime and of the robot on aarch64, under an emulator", work: Work::Aarch64 },
    // The tests have built them.
    Check { title: "examples", work: Work::Examples },
    check_in(
        &[("RUSTDOCFLAGS", "--deny=warnings")],
        "documentation",
        "doc --workspace --exclude xtask --exclude vibrissa-python --no-deps --lib",
    ),
    // Cargo would need the runtime from a registry to build the package, or to write its lock file.
    check(
        "packages, not built",
        "package --quiet --workspace --exclude xtask --exclude vibrissa-python --allow-dirty --no-verify --exclude-lockfile",
    ),
    // Not `cargo bench -- --test`, which does the same on a second build of everything, in release.
    // The whole workspace, so that dependencies have the features with which the tests were built.
    check("benches, each run once", "test --workspace --bench *"),
    Check { title: "pages in a browser", work: Work::Browser },
    // The dependencies are those of the tests, and so is the program that it is compared with.
    Check { title: "Python package", work: Work::Python },
    Check { title: "nothing left behind", work: Work::CheckoutIsUntouched },
];

const fn check(title: &'static str, arguments: &'static str) -> Check {
    check_in(&[], title, arguments)
}

const fn check_in(
    environment: &'static [(&'static str, &'static str)],
    title: &'static str,
    arguments: &'static str,
) -> Check {
    Check { title, work: Work::Cargo(CargoRun { environment, arguments }) }
}

/// Which checks run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Chosen {
    /// All from this one, counted from 1.
    From(usize),
    /// All before the tests, so that a machine can do them beside another one with the rest.
    Lints,
    /// The set-up, the tests, and what is made of their build.
    Tests,
}

/// Runs the checks in the checkout at `root` until one fails, and sums up.
pub(crate) fn run(root: &Path, chosen: Chosen) -> Result<(), CheckError> {
    let tests = CHECKS.iter().position(|check| check.title == "tests").unwrap_or_default();
    let checks: Vec<(usize, &Check)> = (1..)
        .zip(&CHECKS)
        .filter(|&(number, check)| match chosen {
            Chosen::From(from) => number >= from,
            Chosen::Lints => number <= tests,
            Chosen::Tests => number > tests || matches!(check.work, Work::Setup),
        })
        .collect();
    if let (Chosen::From(number), true) = (chosen, checks.is_empty()) {
        return Err(CheckError::NoSuchCheck { number });
    }
    let before = Checkout::look(root);
    let start = Instant::now();
    let mut times = Vec::with_capacity(checks.len());
    let mut result = Ok(());
    for &(number, check) in &checks {
        println!("\n[{number}/{}] {}", CHECKS.len(), check.title);
        let check_start = Instant::now();
        result = check.run(root, before.as_ref());
        times.push(check_start.elapsed());
        if result.is_err() {
            break;
        }
    }
    println!(
        "\n{}",
        summary(&checks.iter().map(|&(_, check)| check).collect::<Vec<_>>(), &times, result.is_ok(), start.elapsed())
    );
    result
}

impl Check {
    fn run(&self, root: &Path, before: Option<&Checkout>) -> Result<(), CheckError> {
        match &self.work {
            Work::Cargo(run) => run.succeed(self.title, root),
            Work::CoreIsFreeOfMujoco => core_is_free_of_mujoco(self.title, root),
            Work::Setup => Ok(setup::setup(root, &Options::default())?),
            Work::Commits => Ok(commits::check(root)?),
            Work::Runtime => Ok(runtime::check(root)?),
            Work::Aarch64 => Ok(runtime::test_on_aarch64(root, SAME_CASES)?),
            Work::Prose => {
                prose::check(root)?;
                Ok(comments::check(root)?)
            }
            Work::Links => Ok(links::check(root)?),
            Work::Results => Ok(results::check(root)?),
            Work::Book => the_book_is_built(root),
            Work::Web => with_browser_tools(web::check(root)),
            Work::Browser => with_browser_tools(web::browse(root)),
            Work::Examples => examples_run(self.title, root),
            Work::Python => Ok(python::test(root)?),
            Work::CheckoutIsUntouched => checkout_is_untouched(root, before),
        }
    }
}

impl CargoRun {
    fn command(&self, root: &Path) -> Command {
        cargo(root, &self.arguments.split(' ').collect::<Vec<_>>())
    }

    fn succeed(&self, title: &'static str, root: &Path) -> Result<(), CheckError> {
        println!("      {self}");
        let mut command = self.command(root);
        command.envs(self.environment.iter().copied());
        let status = command.status().map_err(|source| NotStarted { program: "cargo", source })?;
        if status.success() { Ok(()) } else { Err(CheckError::Failed { title, status, rerun: self.to_string() }) }
    }
}

/// The line that does the same in a shell.
impl std::fmt::Display for CargoRun {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (name, value) in self.environment {
            write!(f, "{name}={value} ")?;
        }
        write!(f, "cargo {}", self.arguments)
    }
}

fn core_is_free_of_mujoco(title: &'static str, root: &Path) -> Result<(), CheckError> {
    const TREE: CargoRun =
        CargoRun { environment: &[], arguments: "tree --package vibrissa --no-default-features --edges normal,build" };
    let mut command = TREE.command(root);
    let output = command.stderr(Stdio::inherit()).output().map_err(|source| NotStarted { program: "cargo", source })?;
    if !output.status.success() {
        return Err(CheckError::Failed { title, status: output.status, rerun: TREE.to_string() });
    }
    let tree = String::from_utf8_lossy(&output.stdout);
    if tree.contains("mujoco-rs") { Err(CheckError::CoreNeedsMujoco) } else { Ok(()) }
}

/// The folders with examples.
const EXAMPLES: [&str; 2] = ["examples", "crates/runtime/examples"];

/// Runs every example as a program. They are built as one workspace, as the tests have built them. `cargo run` of one
/// package would build dependencies again, because they get fewer features.
fn examples_run(title: &'static str, root: &Path) -> Result<(), CheckError> {
    const BUILD: CargoRun = CargoRun { environment: &[], arguments: "build --workspace --examples" };
    BUILD.succeed(title, root)?;
    let programs = target_directory(root).join("debug/examples");
    for folder in EXAMPLES {
        let entries = fs::read_dir(root.join(folder)).map_err(CheckError::Examples)?;
        let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>();
        let mut paths = paths.map_err(CheckError::Examples)?;
        paths.sort();
        let sources = paths.iter().filter(|path| path.extension().is_some_and(|end| end == "rs"));
        for name in sources.filter_map(|path| path.file_stem()) {
            let program = programs.join(name).with_extension(env::consts::EXE_EXTENSION);
            let rerun = program.display().to_string();
            println!("      {rerun}");
            let status = Command::new(&program).current_dir(root).status().map_err(CheckError::Examples)?;
            if !status.success() {
                return Err(CheckError::Failed { title, status, rerun });
            }
        }
    }
    Ok(())
}

/// Without mdBook there is no book, which is no fault of the documentation.
fn the_book_is_built(root: &Path) -> Result<(), CheckError> {
    match book::build(root) {
        Ok(_) => Ok(()),
        Err(BookError::NoMdbook(said)) => {
            println!("      left out: there is no mdBook here, and pip did not install it:\n{said}");
            Ok(())
        }
        Err(error) => Err(error.into()),
    }
}

/// Outside of CI, a check is left out if its tools are missing.
fn with_browser_tools(result: Result<(), WebError>) -> Result<(), CheckError> {
    match result {
        Err(missing @ (WebError::NoNpm | WebError::NoChromium)) if env::var_os("CI").is_none() => {
            println!("      left out: {missing}");
            Ok(())
        }
        result => Ok(result?),
    }
}

fn checkout_is_untouched(root: &Path, before: Option<&Checkout>) -> Result<(), CheckError> {
    let (Some(before), Some(now)) = (before, Checkout::look(root)) else {
        println!("      left out: this is not a Git checkout");
        return Ok(());
    };
    let left_behind = now.since(before);
    if left_behind.is_empty() { Ok(()) } else { Err(CheckError::LeftBehind(left_behind.join("\n  "))) }
}

/// A line for each check that ran, and one for all.
fn summary(checks: &[&Check], times: &[Duration], passed: bool, total: Duration) -> String {
    let last = times.len().saturating_sub(1);
    let mut lines: Vec<_> = checks
        .iter()
        .zip(times)
        .enumerate()
        .map(|(index, (check, time))| {
            let word = if passed || index < last { "ok" } else { "FAILED" };
            format!("{word:>6} {:>7.1} s  {}", time.as_secs_f64(), check.title)
        })
        .collect();
    let left = checks.len() - times.len();
    let outcome = if passed { "all checks passed".to_owned() } else { format!("stopped, {left} checks left") };
    lines.push(format!("       {:>7.1} s  {outcome}", total.as_secs_f64()));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn position(title: &str) -> Option<usize> {
        CHECKS.iter().position(|check| check.title == title)
    }

    #[test]
    fn the_core_is_compiled_before_mujoco_is_fetched_and_the_rest_after() {
        let core = position("lints of the core, without MuJoCo");
        assert!(core.is_some() && core < position("set-up"));
        assert!(position("set-up") < position("lints"));
        assert!(position("set-up") < position("tests"));
    }

    #[test]
    fn a_check_is_shown_as_a_line_for_the_shell() {
        let run = CargoRun { environment: &[("RUSTDOCFLAGS", "--deny=warnings")], arguments: "doc --no-deps" };
        assert_eq!(run.to_string(), "RUSTDOCFLAGS=--deny=warnings cargo doc --no-deps");
    }

    #[test]
    fn the_summary_says_which_check_failed_and_how_many_did_not_run() {
        let second = Duration::from_secs(1);
        let text = summary(&CHECKS.iter().collect::<Vec<_>>(), &[second, second], false, second * 2);
        let lines: Vec<_> = text.lines().map(str::trim).collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("ok") && lines[1].starts_with("FAILED"), "{text}");
        assert!(lines[2].ends_with(&format!("stopped, {} checks left", CHECKS.len() - 2)), "{text}");
    }
}
