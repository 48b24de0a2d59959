//! Instruction counts of whole runs beside stored ones.
//!
//! Other programs on the machine change times, but not the number of instructions of one thread. Valgrind counts them.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{fs, io};

use thiserror::Error;

use crate::cargo::{NotStarted, cargo, target_directory};
use crate::setup::{self, Options as SetupOptions, SetupError};

/// Where the counts are stored.
const STORED: &str = "benches/instructions.csv";
/// Its first line.
const HEADING: &str = "run,million instructions,reason of the last change";
/// The relative difference from a stored count that is no change.
const TOLERANCE: f64 = 0.03;
/// The name of the function whose calls are a tick, as Valgrind takes it.
const TICK: &str = "--toggle-collect=*Control*tick_observed*";
/// Where files of the runs are written, below the target directory.
const FOLDER: &str = "instructions";
/// The environment variable for the cache of the program, and its folder in [`FOLDER`].
const CACHE: (&str, &str) = ("VIBRISSA_CACHE", "cache");
/// A run whose policy compiles into the cache, which all counted runs find there.
const FIRST: [&str; 2] =
    ["run disk --world quasistatic --policy thesis", "run disk --world quasistatic --policy vibrissa"];

/// What to count, and what to do with it.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Options {
    /// Why changed counts are stored. `None` if they are an error.
    pub(crate) accept: Option<String>,
    /// The program to run instead of building it.
    pub(crate) program: Option<PathBuf>,
}

/// Why the counts are not those that are stored, or unknown.
#[derive(Debug, Error)]
pub(crate) enum InstructionsError {
    #[error("the program cannot be built; why is above")]
    Build,
    #[error("{}: {source}; look at its permissions", path.display())]
    File { path: PathBuf, source: io::Error },
    #[error(
        "{} is not there, so there is nothing to compare with; store the first counts: cargo x instructions --accept \"WHY\"",
        path.display()
    )]
    NoCounts { path: PathBuf },
    #[error("{}, line {line}: this is not a name, a count and a reason; accept all counts anew", path.display())]
    Line { path: PathBuf, line: usize },
    #[error("`vibrissa {arguments}` was not counted: {told}")]
    Run { arguments: String, told: String },
    #[error(
        "the instructions of {} changed by more than {} %. If that is meant: cargo x instructions --accept \"WHY\"",
        .0.join(", "),
        TOLERANCE * 100.0
    )]
    Changed(Vec<String>),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cargo(#[from] NotStarted),
}

/// Millions of instructions of runs by name, each with the reason of its last change.
type Counts = BTreeMap<String, (f64, String)>;

/// A run of the program.
struct Run {
    name: &'static str,
    arguments: &'static str,
    /// True if only control ticks are counted.
    only_ticks: bool,
}

const fn whole(name: &'static str, arguments: &'static str) -> Run {
    Run { name, arguments, only_ticks: false }
}

const fn ticks(name: &'static str, arguments: &'static str) -> Run {
    Run { name, arguments, only_ticks: true }
}

/// The runs. `{}` is the folder of [`scenarios`].
const RUNS: &[Run] = &[
    whole("disk, quasi-static, thesis", "run disk --simulator quasistatic --policy thesis"),
    whole("disk, quasi-static, vibrissa", "run disk --simulator quasistatic --policy vibrissa"),
    whole("round tunnel, quasi-static", "run round-tunnel --simulator quasistatic --policy thesis"),
    whole("disk, MuJoCo, thesis", "run disk --simulator mujoco --policy thesis"),
    whole("octagon, MuJoCo, vibrissa", "run octagon --simulator mujoco --policy vibrissa"),
    whole("zigzag, MuJoCo, vibrissa", "run zigzag-tunnel --simulator mujoco --policy vibrissa"),
    whole("600 s on a disk", "run {}/long.yaml --simulator quasistatic --policy policies/bang.fsm"),
    whole("50 far objects", "run {}/far.yaml --simulator quasistatic --policy thesis"),
    whole("compile", "compile policies/explore.fsm -o {}/explore.machine"),
    whole("check", "check policies/vibrissa.fsm"),
    ticks("ticks in the air", "run {}/air.yaml --simulator quasistatic --policy vibrissa"),
    ticks("ticks on a disk", "run disk --simulator quasistatic --policy vibrissa"),
    ticks("ticks in a tunnel", "run round-tunnel --simulator quasistatic --policy vibrissa"),
];

/// The scenarios that only these runs have.
fn scenarios() -> [(&'static str, String); 3] {
    let disk = "objects:\n  - circle: {centre: [0.4 m, 0.4 m], radius: 0.3 m}\n";
    let start = |place: &str| format!("start: {{position: [{place}], heading: 90 deg}}\n");
    let far = (0..50).fold(String::new(), |mut text, index| {
        // Writing to a string cannot fail.
        let (x, y) = (2.0 + 0.4 * f64::from(index % 10), 2.0 + 0.4 * f64::from(index / 10));
        let _ = writeln!(text, "  - circle: {{centre: [{x:.1} m, {y:.1} m], radius: 30 mm}}");
        text
    });
    let closed = "stop: {time: 120 s, loop_closed: {within: 5 mm, after: 5 s}}\n";
    [
        ("long.yaml", format!("name: long\n{disk}{}stop: {{time: 600 s}}\n", start("0 m, 72 mm"))),
        ("far.yaml", format!("name: far\n{disk}{far}{}{closed}", start("0 m, 72 mm"))),
        ("air.yaml", format!("name: air\n{disk}{}stop: {{time: 10 s}}\n", start("-3 m, 72 mm"))),
    ]
}

/// Counts the instructions of all runs and compares them with the stored ones.
pub(crate) fn instructions(root: &Path, options: &Options) -> Result<(), InstructionsError> {
    let path = root.join(STORED);
    let stored = stored(&path, options.accept.is_some())?;
    let has_valgrind = Command::new("valgrind").arg("--version").stdout(Stdio::null()).status();
    if !has_valgrind.is_ok_and(|status| status.success()) {
        println!("Instructions are not counted: there is no `valgrind` (the Debian package of that name).");
        return Ok(());
    }
    let program = match &options.program {
        Some(program) => program.clone(),
        None => build(root)?,
    };
    let folder = target_directory(root).join(FOLDER);
    let fault = |path: &Path| {
        let path = path.to_owned();
        move |source| InstructionsError::File { path, source }
    };
    fs::create_dir_all(&folder).map_err(fault(&folder))?;
    for (name, text) in scenarios() {
        let path = folder.join(name);
        fs::write(&path, text).map_err(fault(&path))?;
    }
    for arguments in FIRST {
        let mut command = Command::new(&program);
        command.current_dir(root).env(CACHE.0, folder.join(CACHE.1));
        let run = command.args(arguments.split(' ')).stdout(Stdio::null()).stderr(Stdio::null()).status();
        run.map_err(fault(&program))?;
    }
    let mut changed = Vec::new();
    let mut text = format!("{HEADING}\n");
    for run in RUNS {
        let counted = count(root, (&program, &folder), run)?;
        let (before, reason) = stored.get(run.name).map_or((None, ""), |(count, reason)| (Some(*count), &**reason));
        let is_same = before.is_some_and(|before| (counted - before).abs() <= TOLERANCE * before);
        let beside = before.map_or_else(String::new, |before| format!("{:+.1} %", 100.0 * (counted / before - 1.0)));
        println!("{:32} {counted:10.1} M {beside:>9}{}", run.name, if is_same { "" } else { "  changed" });
        let (kept, reason) = match (&options.accept, before) {
            (_, Some(before)) if is_same => (before, reason),
            (Some(accept), _) => (counted, accept.as_str()),
            (None, _) => {
                changed.push(run.name.to_owned());
                (counted, reason)
            }
        };
        let _ = writeln!(text, "{},{kept:.1},{reason}", run.name.replace(',', ";"));
    }
    if !changed.is_empty() {
        return Err(InstructionsError::Changed(changed));
    }
    if options.accept.is_some() { fs::write(&path, text).map_err(fault(&path)) } else { Ok(()) }
}

fn build(root: &Path) -> Result<PathBuf, InstructionsError> {
    setup::setup(root, &SetupOptions::default())?;
    let built = cargo(root, &["build", "--release", "--package", "vibrissa"]).status();
    let built = built.map_err(|source| NotStarted { program: "cargo", source })?;
    if built.success() { Ok(target_directory(root).join("release/vibrissa")) } else { Err(InstructionsError::Build) }
}

/// Millions of instructions of a run.
fn count(root: &Path, (program, folder): (&Path, &Path), run: &Run) -> Result<f64, InstructionsError> {
    let arguments = run.arguments.replace("{}", &folder.to_string_lossy());
    let mut command = Command::new("valgrind");
    command.current_dir(root).env(CACHE.0, folder.join(CACHE.1));
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    if run.only_ticks {
        command.args(["--collect-atstart=no", TICK]);
    }
    let output = command.arg(program).args(arguments.split(' ')).stdout(Stdio::null()).output();
    let output = output.map_err(|source| InstructionsError::File { path: program.to_owned(), source })?;
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let collected = collected(&told).filter(|&count| count > 0.0);
    collected.map(|count| count / 1e6).ok_or(InstructionsError::Run { arguments, told })
}

/// The number that Valgrind reports at the end.
fn collected(told: &str) -> Option<f64> {
    let (_, behind) = told.rsplit_once("Collected : ")?;
    behind.split_whitespace().next()?.parse().ok()
}

/// The stored counts in the file at `path`. Only if new ones are accepted, there need not be any.
fn stored(path: &Path, are_accepted: bool) -> Result<Counts, InstructionsError> {
    match fs::read_to_string(path) {
        Ok(text) => read(&text).map_err(|line| InstructionsError::Line { path: path.to_owned(), line }),
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
            if are_accepted {
                Ok(Counts::new())
            } else {
                Err(InstructionsError::NoCounts { path: path.to_owned() })
            }
        }
        Err(source) => Err(InstructionsError::File { path: path.to_owned(), source }),
    }
}

/// The counts of a text, or the number of a line that has none.
fn read(text: &str) -> Result<Counts, usize> {
    let lines = text.lines().enumerate().skip(1);
    let read = lines.map(|(index, line)| {
        let (name, rest) = line.split_once(',').ok_or(index + 1)?;
        let (count, reason) = rest.split_once(',').ok_or(index + 1)?;
        let count: f64 = count.parse().map_err(|_| index + 1)?;
        Ok((name.replace(';', ","), (count, reason.to_owned())))
    });
    read.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_is_the_last_one_that_valgrind_reports() {
        let told = "==7== Events    : Ir\n==7== Collected : 1164581301\n==7== \n==7== I   refs:      1,164,581,301\n";
        assert_eq!(collected(told), Some(1_164_581_301.0));
        assert_eq!(collected("==7== no such file\n"), None);
    }

    #[test]
    fn a_name_with_commas_is_stored_and_read() {
        let text = format!("{HEADING}\ndisk; MuJoCo,12.5,scores on demand, and more\n");
        let read = read(&text);
        let expected = (12.5, "scores on demand, and more".to_owned());
        assert_eq!(read, Ok(BTreeMap::from([("disk, MuJoCo".to_owned(), expected)])));
        assert_eq!(super::read("heading\ndisk\n"), Err(2));
    }

    #[test]
    fn counts_that_are_not_there_are_an_error_unless_new_ones_are_accepted() {
        let path = Path::new("no-such-folder/instructions.csv");
        assert!(matches!(stored(path, false), Err(InstructionsError::NoCounts { .. })));
        assert!(stored(path, true).is_ok_and(|counts| counts.is_empty()));
    }

    #[test]
    fn runs_have_different_names() {
        let names: std::collections::BTreeSet<_> = RUNS.iter().map(|run| run.name).collect();
        assert_eq!(names.len(), RUNS.len());
    }
}
