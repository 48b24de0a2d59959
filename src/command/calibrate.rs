//! `vibrissa calibrate`

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::rig::{Rig, Whisker};

use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
use super::trials::make_directory;
use super::values::parse_seed;
use crate::calibration::{Fitted, HeldOut, fit, write_sets};
use crate::file::{CommandFiles, Output, OutputError};
use crate::load;
use crate::physics::{Physics, Preset};
use crate::report::{held_out_table, profile_picture};
use crate::results::Document;
use crate::scenario::write_calibration;

const EXAMPLE: &str = "Example:\n  vibrissa calibrate --out out\n  vibrissa calibrate sets.csv --rig my-rig.yaml --whisker r0 --out out\n\nExit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa calibrate`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct CalibrateArguments {
    /// Measured contacts, as comma-separated values. The columns are `x_mm`, `y_mm`, `base_angle_urad`, and optionally
    /// `normal_deg` and `contact`. Without a file, contacts are simulated
    #[arg(value_name = "SETS")]
    sets: Option<PathBuf>,
    /// Scenario with the rig of the whisker. The default is the reference rig
    #[arg(long, value_name = "SCENARIO")]
    rig: Option<PathBuf>,
    /// Whisker to calibrate. The default is the first whisker of the rig
    #[arg(long, value_name = "NAME")]
    whisker: Option<String>,
    /// Simulate the estimated noise and resolution of the real sensors
    #[arg(long, conflicts_with = "sets")]
    noise: bool,
    /// Seed of the simulated noise
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = parse_seed)]
    seed: u64,
    /// Write the calibration, the contacts and a picture of the deflection profile into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

/// The JSON output.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Printed<'f> {
    whisker: &'f str,
    sets: usize,
    tip_sets: usize,
    held_out: &'f [HeldOut],
}

impl Document for Printed<'_> {
    const FORMAT: &'static str = "calibration";
}

pub(super) fn calibrate(arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (mut rig, physics) = match &arguments.rig {
        Some(scenario) => {
            let scene = load::scenario(scenario, &mut files)?.value;
            (scene.rig, scene.physics)
        }
        None => Preset::default().rig(),
    };
    if arguments.noise {
        rig.sensing.make_real();
    }
    let index = match &arguments.whisker {
        Some(name) => *rig.indices(std::slice::from_ref(name)).map_err(Failure::NoWhisker)?.first().unwrap_or(&0),
        None => 0,
    };
    let whisker = &rig.whiskers[index];
    let measured = match &arguments.sets {
        Some(path) => Some((path, load::contact_sets(path, &mut files)?)),
        None => None,
    };
    make_directory(arguments.out.as_deref())?;
    let report = arguments.out.as_ref().map(|directory| Report::new(directory, &mut files)).transpose()?;
    let (sets, about) = match measured {
        Some((path, sets)) => (sets, format!("{}, measured: {}", whisker.name, path.display())),
        None => (
            simulated(&rig, &physics, index, arguments)?,
            format!("{}, simulated: calibration rig with a rod", whisker.name),
        ),
    };
    let tip_sets = sets.iter().filter(|set| !set.on_shaft).count();
    let fitted = fit(whisker, &sets, format!("{about}, {tip_sets} sets"));
    if fitted.held_out.is_empty() {
        return Err(Failure::TooFewSets { count: tip_sets });
    }
    if let Some(report) = report {
        report.write(whisker, &sets, &fitted)?;
    }
    report_missing(&fitted);
    if arguments.format.json {
        let held_out = &fitted.held_out;
        output::json(&Printed { whisker: &whisker.name, sets: sets.len(), tip_sets, held_out })?;
    } else {
        output::tables(&[held_out_table(&fitted.held_out)], arguments.format.wide)?;
        output::result(format_args!("{} sets, {} of them tip contacts", sets.len(), tip_sets))?;
        if let Some(directory) = &arguments.out {
            output::result(format_args!("calibration: {}", directory.join(FILE).display()))?;
        }
    }
    Ok(Exit::Done)
}

/// Reports the fits that were not possible, and the sets that they need.
fn report_missing(Fitted { calibration, .. }: &Fitted) {
    let missing = [
        (
            calibration.one_channel.is_none(),
            "one_channel",
            "contacts with many base angles, on surfaces nearly parallel to the heading",
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

/// The files for the calibration, its contact sets, and a picture of both.
struct Report {
    calibration: Output,
    sets: Output,
    profile: Output,
}

impl Report {
    fn new(directory: &Path, files: &mut CommandFiles) -> Result<Self, OutputError> {
        let mut file = |name| files.output("--out", &directory.join(name));
        Ok(Self { calibration: file(FILE)?, sets: file("sets.csv")?, profile: file("profile.svg")? })
    }

    fn write(self, whisker: &Whisker, sets: &[ContactSet], fitted: &Fitted) -> Result<(), OutputError> {
        let calibration = &fitted.calibration;
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
    Ok(crate::calibration::simulated_sets(rig, physics, whisker, arguments.seed)?)
}

#[cfg(not(feature = "sim"))]
fn simulated(_: &Rig, _: &Physics, _: usize, _: &CalibrateArguments) -> Result<Vec<ContactSet>, Failure> {
    Err(Failure::NoCalibrationRig)
}
