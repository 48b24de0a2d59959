//! `vibrissa calibrate`

use std::path::Path;

use serde::Serialize;

use crate::calibration::ContactSet;
use crate::report::profile_picture;
use crate::rig::{Rig, Whisker};
use crate::study::calibrate::{Fitted, HeldOut, fit, held_out_table};

use super::arguments::CalibrateArguments;
use super::exit::{Exit, Failure};
use super::run::make_directory;
use super::{file, input, output};

/// What is printed as JSON.
#[derive(Serialize)]
struct Report<'f> {
    whisker: &'f str,
    sets: usize,
    tip_sets: usize,
    held_out: &'f [HeldOut],
}

pub(super) fn calibrate(arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut rig = match &arguments.rig {
        Some(scenario) => input::scenario(scenario)?.value.rig,
        None => Rig::default(),
    };
    if arguments.noise {
        rig.sensing.make_real();
    }
    let index = match &arguments.whisker {
        Some(name) => *rig.indices(std::slice::from_ref(name)).map_err(Failure::NoWhisker)?.first().unwrap_or(&0),
        None => 0,
    };
    let whisker = &rig.whiskers[index];
    make_directory(arguments.out.as_deref())?;
    if let (Some(sets), Some(directory)) = (&arguments.sets, &arguments.out) {
        let copy = directory.join(SETS);
        if file::is_same(sets, &copy) {
            return Err(Failure::OntoItself { path: copy });
        }
    }
    let (sets, about) = match &arguments.sets {
        Some(path) => (input::contact_sets(path)?, format!("{}, measured: {}", whisker.name, path.display())),
        None => (simulated(&rig, index, arguments)?, format!("{}, simulated: a stage before a rod", whisker.name)),
    };
    let tip_sets = sets.iter().filter(|set| !set.on_shaft).count();
    let fitted = fit(whisker, &sets, format!("{about}, {tip_sets} sets"));
    if fitted.held_out.is_empty() {
        return Err(Failure::TooFewSets { count: tip_sets });
    }
    if let Some(directory) = &arguments.out {
        write(directory, whisker, &sets, &fitted)?;
    }
    tell_missing(&fitted);
    if arguments.json {
        let held_out = &fitted.held_out;
        output::json(&Report { whisker: &whisker.name, sets: sets.len(), tip_sets, held_out })?;
    } else {
        output::result(held_out_table(&fitted.held_out))?;
        output::result(format_args!("{} sets, {} of them by the tip", sets.len(), tip_sets))?;
        if let Some(directory) = &arguments.out {
            output::result(format_args!("calibration: {}", directory.join(FILE).display()))?;
        }
    }
    Ok(Exit::Done)
}

/// Tells what could not be fitted, and what that wants.
fn tell_missing(Fitted { calibration, .. }: &Fitted) {
    let missing = [
        (
            calibration.one_channel.is_none(),
            "one_channel",
            "touches of many base angles, on surfaces nearly parallel to the heading",
        ),
        (calibration.recursive.is_none(), "recursive", "touches that lie spread over the plane"),
        (calibration.hinge_stiffness.is_none(), "the base hinge", "a rig whose hinge is within a factor of five of it"),
    ];
    for (_, what, wanted) in missing.iter().filter(|(is_missing, ..)| *is_missing) {
        output::message(format_args!("{what} is not fitted: it wants {wanted}"));
    }
}

/// The names of a calibration's file, and of that of the sets.
const FILE: &str = "calibration.yaml";
const SETS: &str = "sets.csv";

/// Writes the calibration, the sets that it rests on, and a picture of both.
fn write(directory: &Path, whisker: &Whisker, sets: &[ContactSet], fitted: &Fitted) -> Result<(), Failure> {
    let calibration = &fitted.calibration;
    file::write(&directory.join(FILE), calibration.to_yaml())?;
    file::write(&directory.join(SETS), ContactSet::write_all(sets))?;
    let title = format!("Deflection profile of {}", calibration.about);
    let picture = profile_picture(&title, whisker.shaft.length, sets, calibration);
    file::write(&directory.join("profile.svg"), picture)
}

#[cfg(feature = "sim")]
fn simulated(rig: &Rig, whisker: usize, arguments: &CalibrateArguments) -> Result<Vec<ContactSet>, Failure> {
    Ok(crate::study::calibrate::simulated_sets(rig, whisker, arguments.seed)?)
}

#[cfg(not(feature = "sim"))]
fn simulated(_: &Rig, _: usize, _: &CalibrateArguments) -> Result<Vec<ContactSet>, Failure> {
    Err(Failure::NoStage)
}
