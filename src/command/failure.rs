//! Errors of commands.

use std::error::Error;
use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

#[cfg(feature = "live")]
use crate::live::LiveError;
#[cfg(feature = "render")]
use crate::video::VideoError;
#[cfg(feature = "sim")]
use vibrissa_lab::calibration::CalibrationRigError;
use vibrissa_lab::calibration::{ArrayCalibrationError, MIN_POSITIONS};
use vibrissa_lab::family::{FAMILIES, NoDraw};
use vibrissa_lab::load::LoadError;
use vibrissa_lab::property::RegressionsError;
#[cfg(feature = "recording")]
use vibrissa_lab::recording::RecordError;
use vibrissa_lab::request::RequestError;
use vibrissa_lab::study::compare::OlderRunsError;
use vibrissa_lab::study::scale::ScaleError;
use vibrissa_lab::study::stress::CaseError;
use vibrissa_lab::sweep::ResultsError;
use vibrissa_lab::trial::{ExecuteError, StartError, Trial, TrialFault};
use vibrissa_lab::tune::{AxisError, CandidateError};
#[cfg(feature = "viewer")]
use vibrissa_mujoco::visual::WindowError;
use vibrissa_robot::recording::WriteError;
use vibrissa_robot::store::{KeysError, PushError, Refusal, SignedMachineError};
use vibrissa_runtime::machine::{ArtifactError, SetError};
use vibrissa_runtime::rig::UnknownWhisker;
use vibrissa_text::file::OutputError;
use vibrissa_world::mismatch::MismatchError;

use super::exit::Exit;
use super::output;

/// The error of a command.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    #[error(transparent)]
    Load(#[from] LoadError),
    /// What is wrong with a file that could be read, or with its use.
    #[error("{}: {cause}", path.display())]
    At { path: PathBuf, cause: Box<dyn Error + Send + Sync> },
    #[error(transparent)]
    GivenMachine(ArtifactError),
    #[error("cannot make the folder {}: {words}; choose another path with --out", path.display(), words = in_words(cause))]
    Folder { path: PathBuf, cause: std::io::Error },
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("{} is no older report: {cause}; give the directory of an earlier `vibrissa bench --out`", path.display())]
    Older { path: PathBuf, cause: OlderRunsError },
    #[error("cannot write {}: {words}; make it writable, or print the result instead: vibrissa fmt - < {}", path.display(), path.display(), words = in_words(cause))]
    Rewrite { path: PathBuf, cause: std::io::Error },
    #[error("{} is a compiled machine, which has no tests; test its policy", policy.display())]
    NoText { policy: PathBuf },
    #[error(
        "the policy `{name}` is a compiled machine, whose guards have no text; give its policy to use --break or --transitions"
    )]
    NoTextToInspect { name: String },
    #[error("no test has `{filter}` in its title; leave out --filter to run them all")]
    NoSuchTest { filter: String },
    #[error(transparent)]
    Regressions(#[from] RegressionsError),
    #[error(
        "the property \"{title}\" has no scene: in every case the rig touches an object at its start, or objects overlap; choose other ranges"
    )]
    NoScenes { title: String },
    #[error("no case could be drawn: {0}; this is a fault of the program, please report it")]
    NoCase(String),
    #[error(transparent)]
    NoWhisker(UnknownWhisker),
    #[error(
        "{count} tip contacts are too few, or at too few positions; give at least {MIN_POSITIONS} positions, distributed over the plane"
    )]
    TooFewSets { count: usize },
    #[error(transparent)]
    ArrayCalibration(#[from] ArrayCalibrationError),
    #[error("{}: the array cannot be calibrated: {cause}; run it as it is with --uncalibrated", scenario.display())]
    Calibration { scenario: PathBuf, cause: ArrayCalibrationError },
    #[cfg(feature = "sim")]
    #[error(transparent)]
    CalibrationRig(#[from] CalibrationRigError),
    #[cfg(not(feature = "sim"))]
    #[error(
        "this build has no simulator for the calibration rig; give measured contacts, or build with the feature `sim`"
    )]
    NoCalibrationRig,
    #[cfg(feature = "live")]
    #[error(transparent)]
    Live(#[from] LiveError),
    #[error(
        "--break ends a run before the output of {argument} is whole; add --live, whose page shows the breakpoints"
    )]
    BreakOutput { argument: &'static str },
    #[error("--break ends a run, and --watch begins the next one; add --live, whose page shows the breakpoints")]
    BreakWatch,
    #[error("cannot watch files: {0}")]
    Watch(#[from] notify::Error),
    #[error(
        "cannot watch files: the system starts no thread for that ({words}); end other programs, or run without --watch",
        words = in_words(.0)
    )]
    NoWatch(std::io::Error),
    #[error("{} and {} have the same name `{name}`; run them separately", first.display(), second.display())]
    SameName { first: PathBuf, second: PathBuf, name: String },
    #[error("{count} polic{} given; give two or more, such as: vibrissa compare a.fsm b.fsm", if *count == 1 { "y is" } else { "ies are" })]
    TooFewPolicies { count: usize },
    #[error("cannot write {}: {words}", path.display(), words = in_words(cause))]
    Plan { path: PathBuf, cause: std::io::Error },
    #[cfg(unix)]
    #[error(transparent)]
    Stage(#[from] crate::stage::StageError),
    #[error("cannot read standard input: {words}", words = in_words(.0))]
    Standard(std::io::Error),
    #[error("there is no family `{name}`; there are {}", known_families())]
    NoSuchFamily { name: String },
    #[error("scenes of families set the policy's parameters: {0}")]
    FamilySetting(SetError),
    #[error("--set: families set the speed of every scene; for one speed, give --with \"speed=5 cm/s\"")]
    DrawnSpeed,
    #[error("--with: `{name}` of `{family}`: {cause}")]
    FamilyValue { family: String, name: String, cause: String },
    #[error("--param: {0}")]
    Axis(#[from] AxisError),
    #[error("the scene `{scene}` occurs twice; name each scene once")]
    SceneTwice { scene: String },
    #[error("the held-out scene `{scene}` is also a training scene; hold out others")]
    NotHeldOut { scene: String },
    #[error("no scene is held out; name scenarios or families with --held-out")]
    NoHeldOut,
    #[error("these are too few runs for one generation of the search; give at least --runs {needed}, or fewer scenes")]
    FewRuns { needed: usize },
    #[error("{}: --mismatch: {cause}", scenario.display())]
    Mismatch { scenario: PathBuf, cause: MismatchError },
    #[error(transparent)]
    NoDraw(NoDraw),
    #[error("--set: {0}")]
    Set(#[from] SetError),
    #[error("--set: {}: {cause}; choose the policies that have it with --policy", policy.display())]
    SetOf { policy: PathBuf, cause: SetError },
    #[error("{}: {cause}", scenario.display())]
    Execute { scenario: PathBuf, cause: ExecuteError },
    #[error(transparent)]
    World(ExecuteError),
    #[error(transparent)]
    Results(#[from] ResultsError),
    #[error(transparent)]
    Start(#[from] StartError),
    #[error("there are no results of a sweep in {}; `vibrissa sweep FILE --out {}` writes some", directory.display(), directory.display())]
    NoResults { directory: PathBuf },
    #[error(
        "a worker process gave an answer that is not a result ({0}); this is a fault of the program, please report it"
    )]
    Answer(serde_json::Error),
    #[error("a stress test cannot be made: {0}; this is a fault of the program, please report it")]
    Case(#[from] CaseError),
    #[error(transparent)]
    Scale(#[from] ScaleError),
    #[error("cannot write to standard output: {words}", words = in_words(.0))]
    Print(std::io::Error),
    #[cfg(feature = "lsp")]
    #[error("the connection to the editor is lost: {words}", words = in_words(.0))]
    Editor(std::io::Error),
    #[cfg(not(feature = "lsp"))]
    #[error("this build has no language server; build it with one: cargo build --release --features lsp")]
    NoLsp,
    #[error("a statechart cannot be written as `{}`; end the name in .svg, .mmd or .dot, or give --format", .0.display())]
    ChartFile(PathBuf),
    #[error(
        "the real array is driven by the program `vibrissa-robot`, which cannot be started: {words}. Install it on the robot \
         (`cargo x pi`, or `cargo install --path crates/robot`), or drive a simulated array with --emulate SCENARIO",
        words = in_words(.0)
    )]
    NoRobotProgram(std::io::Error),
    #[error("--name: {0}")]
    RobotName(vibrissa_robot::config::ConfigError),
    #[error(
        "the counts do not agree with the mechanics of the whisker `{whisker}`; check --neutral, the positions, and the shaft in \
         the configuration, or measure `field_per_moment` with weights first: it must be right within a factor of five"
    )]
    NoField { whisker: String },
    #[error(transparent)]
    Machine(#[from] SignedMachineError),
    #[error(transparent)]
    Key(#[from] KeysError),
    #[error(transparent)]
    Refused(#[from] Refusal),
    #[error(transparent)]
    Push(#[from] PushError),
    #[error("the run cannot be recorded: {0}")]
    Record(#[from] WriteError),
    #[cfg(feature = "recording")]
    #[error("the run cannot be recorded: {0}")]
    RecordRun(#[from] RecordError),
    #[error("{argument} is for one run, and there are {scenarios} scenarios; give one scenario")]
    OneRun { argument: &'static str, scenarios: usize },
    #[cfg(feature = "render")]
    #[error("--video, {}: {cause}", path.display())]
    Video { path: PathBuf, cause: VideoError },
    #[cfg(feature = "render")]
    #[error(
        "--video {format} names each video after its scenario, in the folder of --out; add --out DIR, or name a file such as run.{format}"
    )]
    NoVideoFolder { format: &'static str },
    #[cfg(feature = "render")]
    #[error(
        "--video {} is one file, and there are {scenarios} scenarios; write --video {format} --out DIR for a video of each, or give one \
         scenario",
        path.display()
    )]
    OneVideo { path: PathBuf, format: &'static str, scenarios: usize },
    #[cfg(feature = "viewer")]
    #[error("--view: {0}")]
    Window(#[from] WindowError),
    #[error("the result cannot be written as JSON: {0}; this is a fault of the program, please report it")]
    Json(#[from] serde_json::Error),
    #[error("the touches cannot be written: {0}; this is a fault of the program, please report it")]
    Touches(#[from] csv::Error),
}

impl Failure {
    /// What is wrong with the content of a file.
    pub(super) fn at<E: Into<Box<dyn Error + Send + Sync>>>(path: &Path) -> impl FnOnce(E) -> Self {
        let path = path.to_owned();
        |cause| Self::At { path, cause: cause.into() }
    }

    /// The error of a trial that cannot begin.
    pub(super) fn execute(trial: &Trial) -> impl FnOnce(ExecuteError) -> Self {
        let scenario = trial.inputs.scenario.clone();
        |cause| Self::Execute { scenario, cause }
    }

    /// The error of a mismatch that does not fit to the rig of a scenario.
    pub(super) fn mismatch(scenario: &Path) -> impl FnOnce(MismatchError) -> Self {
        let scenario = scenario.to_owned();
        |cause| Self::Mismatch { scenario, cause }
    }

    /// The error of an array that cannot be calibrated before the run of a scenario.
    pub(super) fn calibration(scenario: &Path) -> impl FnOnce(ArrayCalibrationError) -> Self {
        let scenario = scenario.to_owned();
        |cause| Self::Calibration { scenario, cause }
    }

    pub(super) fn folder(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        |cause| Self::Folder { path, cause }
    }

    pub(super) fn rewrite(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        |cause| Self::Rewrite { path, cause }
    }

    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Json(_)
            | Self::Touches(_)
            | Self::NoDraw(NoDraw::Random { .. })
            | Self::NoCase(_)
            | Self::Scale(ScaleError::Text(_))
            | Self::Answer(_) => Exit::Internal,
            _ => Exit::Unusable,
        }
    }

    /// Prints the error to standard error.
    pub(super) fn report(&self) {
        match self {
            Self::Load(LoadError::Faults { source_text, faults }) => output::diagnostics(source_text, faults),
            other => output::error(other),
        }
    }
}

impl From<NoDraw> for Failure {
    fn from(error: NoDraw) -> Self {
        match error {
            NoDraw::Written { source_text, faults } => Self::Load(LoadError::Faults { source_text, faults }),
            other => Self::NoDraw(other),
        }
    }
}

impl From<CandidateError> for Failure {
    fn from(error: CandidateError) -> Self {
        match error {
            CandidateError::Draw(cause) => cause.into(),
            CandidateError::Set(cause) => Self::FamilySetting(cause),
        }
    }
}

impl From<RequestError> for Failure {
    fn from(error: RequestError) -> Self {
        error.into_fault().into()
    }
}

impl From<TrialFault> for Failure {
    fn from(fault: TrialFault) -> Self {
        match fault {
            TrialFault::Load(cause) => Self::Load(cause),
            TrialFault::Draw(cause) => cause.into(),
            TrialFault::Mismatch { scenario, cause } => Self::Mismatch { scenario, cause },
            TrialFault::Calibration { scenario, cause } => Self::Calibration { scenario, cause },
            TrialFault::Set(cause) => Self::Set(cause),
            TrialFault::Machine(cause) => Self::GivenMachine(cause),
            TrialFault::Execute { scenario, cause } => Self::Execute { scenario, cause },
        }
    }
}

fn known_families() -> String {
    FAMILIES.map(|family| format!("`{}`", family.name)).join(", ")
}
