//! `vibrissa calibrate`

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use serde::Serialize;
use vibrissa_robot::array::Transducer;
use vibrissa_robot::config::{BoardConfig, Config};
use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::rig::{Rig, Whisker};

use super::calibrate_array::{calibrate_array, calibrate_touches};
use super::calibrate_plan::calibrate_plan;
use super::calibrate_pluck::calibrate_pluck;
use super::drive::config;
use super::exit::Exit;
use super::failure::Failure;
use super::options::{Format, Jobs, MismatchOptions, WorldOptions};
use super::output;
use super::provenance::provenance;
#[cfg(unix)]
use super::stage_options::StageOptions;
use super::trials::make_directory;
use super::values::{parse_heading, parse_jitter, parse_jitter_heading, parse_runs, parse_seed};
use vibrissa_lab::calibration::{CountSet, Fitted, HeldOut, fit, fit_field, write_sets};
use vibrissa_lab::load::{self, LoadError, WithoutEffect};
use vibrissa_lab::report::{held_out_table, profile_picture};
use vibrissa_lab::results::Document;
use vibrissa_text::file::{CommandFiles, Output, OutputError};
use vibrissa_world::physics::{Physics, Preset};
use vibrissa_world::scenario::{write_calibration, write_robot_calibration};

const EXAMPLE: &str = "Example:\n  vibrissa calibrate --out out\n  vibrissa calibrate sets.csv --rig my-rig.yaml --whisker r0 --out out\n  vibrissa calibrate counts.csv --config array.yaml --neutral -812 --whisker r0 --out out\n  vibrissa calibrate --self --mismatch scenarios/mismatch/plausible.yaml --out out\n  vibrissa calibrate --touches out/touches.csv --rig my-rig.yaml --out measured\n  vibrissa calibrate --pluck pluck.csv --whisker r0\n\nExit status: 0 done; 1 a whisker is refused; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa calibrate`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
#[command(group = ArgGroup::new("of_array").args(["mismatch_file", "mismatch_seed", "world", "no_prune", "jobs"]).multiple(true).requires("itself"))]
#[command(group = ArgGroup::new("touched").args(["touches", "plan"]))]
pub(super) struct CalibrateArguments {
    /// Let the array of the rig touch a pin and measure its own whiskers, in a simulator. Writes a calibration for each whisker
    #[arg(long = "self", conflicts_with_all = ["sets", "config", "whisker"])]
    itself: bool,
    /// Number of arrays, from 1 to 100000. Each further array has the next seeds. For statistics, without `--out`
    #[arg(long, value_name = "N", default_value_t = 1, requires = "itself", conflicts_with = "out", allow_negative_numbers = true, value_parser = parse_runs)]
    pub(super) arrays: u64,
    #[command(flatten)]
    pub(super) jobs: Jobs,
    /// Measured touches of a pin, edges or faces by any whiskers of the rig, as comma-separated values. Writes a calibration for each
    /// whisker that has touches
    #[arg(long, value_name = "FILE", conflicts_with_all = ["itself", "sets", "config", "whisker", "noise"])]
    touches: Option<PathBuf>,
    /// Recording of a run, or comma-separated values with the columns `time_s` and `base_angle_urad`, in which a whisker is bent and
    /// released in the air. Prints its first mode and decay
    #[arg(long, value_name = "FILE", conflicts_with_all = ["itself", "sets", "config", "touches", "noise", "rig", "out"])]
    pluck: Option<PathBuf>,
    /// File of touches of a pin so far, which may be missing. Prints the poses of the platform for the next touch. The pin is the origin
    /// of the world frame
    #[arg(long, value_name = "FILE", conflicts_with_all = ["itself", "sets", "config", "noise", "touches", "pluck"])]
    plan: Option<PathBuf>,
    /// Read the base angle of each planned touch and that in the air (urad) from a line of standard input, or `missed`, or the name of a
    /// file with readings from the air to the touch. Touches are added to the file until no further one is planned, and then fitted
    #[arg(long = "continue", requires = "plan")]
    pub(super) continued: bool,
    /// Radius of the pin. The default is a tenth of the length of a whisker
    #[arg(long, value_name = "LENGTH", requires = "plan", value_parser = parse_jitter)]
    pub(super) pin_radius: Option<f64>,
    /// Heading of the platform in all touches
    #[arg(long, value_name = "ANGLE", default_value = "90 deg", requires = "plan", allow_hyphen_values = true, value_parser = parse_heading)]
    pub(super) heading: f64,
    /// Standard deviation of the position of the platform relative to the object in measured touches, in each direction
    #[arg(long, value_name = "LENGTH", default_value = "0.05 mm", requires = "touched", value_parser = parse_jitter)]
    pub(super) position_noise: f64,
    /// Standard deviation of the heading of the platform in measured touches
    #[arg(long, value_name = "ANGLE", default_value = "0.02 deg", requires = "touched", value_parser = parse_jitter_heading)]
    pub(super) heading_noise: f64,
    #[cfg(unix)]
    #[command(flatten)]
    pub(super) stage: StageOptions,
    #[command(flatten)]
    pub(super) world: WorldOptions,
    #[command(flatten)]
    pub(super) mismatch: MismatchOptions,
    /// Measured contacts, as comma-separated values. The columns are `x_mm`, `y_mm`, `base_angle_urad` or `counts`, and
    /// optionally `normal_deg` and `contact`. Without a file, contacts are simulated
    #[arg(value_name = "SETS")]
    sets: Option<PathBuf>,
    /// Scenario with the rig of the whisker. The default is the reference rig
    #[arg(long, value_name = "SCENARIO")]
    pub(super) rig: Option<PathBuf>,
    /// Configuration of the robot, for contacts with the counts of its sensor. It has the rig, the settings of the sensor and
    /// the board of the whisker
    #[arg(long, value_name = "FILE", requires_all = ["sets", "neutral"], conflicts_with_all = ["rig", "noise"])]
    config: Option<PathBuf>,
    /// Counts of the whisker at rest, measured with the contacts
    #[arg(long, value_name = "COUNTS", requires = "config", allow_negative_numbers = true)]
    neutral: Option<f64>,
    /// Whisker to calibrate. The default is the first whisker of the rig, and with --plan all of them
    #[arg(long, value_name = "NAME")]
    pub(super) whisker: Option<String>,
    /// Simulate the estimated noise and resolution of the real sensors
    #[arg(long, conflicts_with = "sets")]
    pub(super) noise: bool,
    /// Seed of the simulated noise. The default is 0. Refused if nothing has noise
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_seed)]
    pub(super) seed: Option<u64>,
    /// Write the calibration, the contacts and a picture of the deflection profile into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    #[command(flatten)]
    pub(super) format: Format,
}

/// The JSON output.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Printed<'f> {
    whisker: &'f str,
    sets: usize,
    tip_sets: usize,
    /// Field at the sensor per base moment (T/(N m)). `null` if the contacts have no counts.
    field_per_moment: Option<f64>,
    held_out: &'f [HeldOut],
}

impl Document for Printed<'_> {
    const FORMAT: &'static str = "calibration";
}

pub(super) fn calibrate(arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    if arguments.itself {
        return calibrate_array(arguments);
    }
    if let Some(path) = &arguments.pluck {
        return calibrate_pluck(path, arguments);
    }
    if let Some(path) = &arguments.plan {
        return calibrate_plan(path, arguments);
    }
    if arguments.seed.is_some() && !arguments.noise {
        return Err(LoadError::from(WithoutEffect::Noise).into());
    }
    if let Some(path) = &arguments.touches {
        return calibrate_touches(path, arguments);
    }
    let mut files = CommandFiles::new();
    let robot = match &arguments.config {
        Some(path) => Some((path, config(path, &mut files)?.0)),
        None => None,
    };
    let (mut rig, physics) = match (&robot, &arguments.rig) {
        (Some((_, robot)), _) => (uncalibrated(&robot.rig), Preset::default().rig().1),
        (None, Some(scenario)) => {
            let scene = load::scenario(scenario, &mut files)?.value;
            (scene.rig, scene.physics)
        }
        (None, None) => Preset::default().rig(),
    };
    if arguments.noise {
        rig.sensing.make_real();
    }
    let index = match &arguments.whisker {
        Some(name) => *rig.indices(std::slice::from_ref(name)).map_err(Failure::NoWhisker)?.first().unwrap_or(&0),
        None => 0,
    };
    let whisker = &rig.whiskers[index];
    let measured = match (&arguments.sets, &robot) {
        (Some(path), Some((file, robot))) => {
            let sets = load::count_sets(path, &mut files)?;
            Some((path, counted(&sets, whisker, (file, robot), arguments.neutral.unwrap_or_default())?))
        }
        (Some(path), None) => Some((path, (load::contact_sets(path, &mut files)?, None))),
        (None, _) => None,
    };
    make_directory(arguments.out.as_deref())?;
    let has_board = robot.is_some();
    let report = arguments.out.as_ref().map(|directory| Report::new(directory, has_board, &mut files)).transpose()?;
    let ((sets, board), about) = match measured {
        Some((path, measured)) => (measured, format!("{}, measured: {}", whisker.name, path.display())),
        None => (
            (simulated(&rig, &physics, index, arguments)?, None),
            format!("{}, simulated: calibration rig with a rod", whisker.name),
        ),
    };
    let tip_sets = sets.iter().filter(|set| !set.on_shaft).count();
    let mut fitted = fit(whisker, &sets, format!("{about}, {tip_sets} sets"));
    if fitted.held_out.is_empty() {
        return Err(Failure::TooFewSets { count: tip_sets });
    }
    report_missing(&fitted);
    if board.is_some() {
        // The field per moment has taken the place of the stiffness.
        fitted.calibration.hinge_stiffness = None;
    }
    if let Some(report) = report {
        report.write(whisker, &sets, &fitted, board.as_ref())?;
    }
    if arguments.format.json {
        let held_out = &fitted.held_out;
        let field_per_moment = board.as_ref().map(|board| board.field_per_moment);
        output::json(
            &provenance(),
            &Printed { whisker: &whisker.name, sets: sets.len(), tip_sets, field_per_moment, held_out },
        )?;
    } else {
        output::tables(&[held_out_table(&fitted.held_out)], arguments.format.wide)?;
        output::result(format_args!("{} sets, {} of them tip contacts", sets.len(), tip_sets))?;
        if let Some(board) = &board {
            output::result(format_args!("board: {}", line(board)))?;
        }
        if let Some(directory) = &arguments.out {
            output::result(format_args!("calibration: {}", directory.join(FILE).display()))?;
        }
    }
    Ok(Exit::Done)
}

/// A rig without the calibrations of its whiskers.
fn uncalibrated(rig: &Rig) -> Rig {
    let mut rig = rig.clone();
    for whisker in &mut rig.whiskers {
        whisker.calibration = None;
    }
    rig
}

/// Contacts with base angles from contacts with counts, and the board with the fitted field per moment.
fn counted(
    sets: &[CountSet],
    whisker: &Whisker,
    (path, robot): (&Path, &Config),
    neutral: f64,
) -> Result<(Vec<ContactSet>, Option<BoardConfig>), Failure> {
    let found = Transducer::of(robot, whisker);
    let (board, transducer) = found.map_err(Failure::at(path))?;
    let transducer = fit_field(whisker, sets, &Transducer { neutral, ..transducer })
        .ok_or_else(|| Failure::NoField { whisker: whisker.name.clone() })?;
    let board = BoardConfig { field_per_moment: transducer.magnet.field_per_moment, ..board.clone() };
    Ok((sets.iter().map(|set| set.converted(&transducer)).collect(), Some(board)))
}

/// A board as a line of the robot's configuration.
fn line(board: &BoardConfig) -> String {
    let BoardConfig { whisker, address, field_per_moment, cubic } = board;
    let cubic = if *cubic == 0.0 { String::new() } else { format!(", cubic: {cubic:?}") };
    format!("{{whisker: {whisker}, address: {address:#04x}, field_per_moment: {field_per_moment:.4}{cubic}}}")
}

/// Reports the fits that were not possible, and the sets that they need.
fn report_missing(Fitted { calibration, .. }: &Fitted) {
    let missing = [
        (
            calibration.one_channel.is_none(),
            "one_channel",
            "contacts with many base angles, on surfaces nearly parallel to the heading",
        ),
        (
            calibration.polynomial.is_none(),
            "polynomial",
            "contacts with many base angles up to 500 urad, on surfaces nearly parallel to the heading",
        ),
        (calibration.recursive.is_none(), "recursive", "contacts distributed over the plane"),
        (
            calibration.hinge_stiffness.is_none(),
            "the base hinge",
            "a rig with a hinge stiffness within a factor of five of the measured one",
        ),
    ];
    for (_, name, needed) in missing.iter().filter(|(is_missing, ..)| *is_missing) {
        output::message(format_args!("{name} is not fitted: it needs {needed}"));
    }
}

/// The name of a calibration's file.
const FILE: &str = "calibration.yaml";

/// The files for the calibration, its contact sets, a picture of both, and the parts of a robot's configuration.
struct Report {
    robot: Option<Output>,
    calibration: Output,
    sets: Output,
    profile: Output,
}

impl Report {
    fn new(directory: &Path, has_board: bool, files: &mut CommandFiles) -> Result<Self, OutputError> {
        let mut file = |name| files.output("--out", &directory.join(name));
        let robot = has_board.then(|| file("robot.yaml")).transpose()?;
        Ok(Self { robot, calibration: file(FILE)?, sets: file("sets.csv")?, profile: file("profile.svg")? })
    }

    fn write(
        self,
        whisker: &Whisker,
        sets: &[ContactSet],
        fitted: &Fitted,
        board: Option<&BoardConfig>,
    ) -> Result<(), OutputError> {
        let calibration = &fitted.calibration;
        if let (Some(robot), Some(board)) = (self.robot, board) {
            robot.write(write_robot_calibration(&whisker.name, &line(board), calibration))?;
        }
        self.calibration.write(write_calibration(calibration))?;
        self.sets.write(write_sets(sets))?;
        let title = format!("Deflection profile of {}", calibration.about);
        self.profile.write(profile_picture(&title, whisker.shaft.length, sets, calibration))
    }
}

#[cfg(feature = "sim")]
fn simulated(
    rig: &Rig,
    physics: &Physics,
    whisker: usize,
    arguments: &CalibrateArguments,
) -> Result<Vec<ContactSet>, Failure> {
    Ok(vibrissa_lab::calibration::simulated_sets(rig, physics, whisker, arguments.seed.unwrap_or(0))?)
}

#[cfg(not(feature = "sim"))]
fn simulated(_: &Rig, _: &Physics, _: usize, _: &CalibrateArguments) -> Result<Vec<ContactSet>, Failure> {
    Err(Failure::NoCalibrationRig)
}
