//! `vibrissa calibrate --self`

use std::path::Path;

use serde::Serialize;
use sha2::Sha256;
use vibrissa_runtime::calibration::{Parameter, TouchFit};

use super::calibrate::CalibrateArguments;
use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::trials::make_directory;
use crate::built_in::SCENARIOS;
use crate::calibration::{TouchLimits, WhiskerTouches, undetermined};
use crate::file::CommandFiles;
use crate::load;
use crate::report::measured_table;
use crate::results::Document;
use crate::scenario::write_calibration;
use crate::study::ArrayCalibration;

/// The JSON output for one whisker.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct MeasuredDocument {
    whisker: String,
    /// Number of touches, and of those in which the whisker slipped off the pin.
    touches: usize,
    missed: usize,
    /// Duration (s).
    time: f64,
    /// The reason why the whisker is not calibrated.
    refusal: Option<String>,
    /// Standard deviation of tips due to the parameters (mm).
    tip_deviation_mm: Option<f64>,
    chi_square: Option<f64>,
    /// The parameters as differences from the rig (SI).
    parameters: Vec<MeasuredParameter>,
    /// Combinations of parameters, in units of the tolerances, that the touches do not determine.
    undetermined: Vec<String>,
}

/// A measured parameter as the difference from the rig, with its standard deviation (SI).
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct MeasuredParameter {
    name: &'static str,
    difference: f64,
    deviation: f64,
}

impl Document for MeasuredDocument {
    const FORMAT: &'static str = "array_calibration";
}

impl MeasuredDocument {
    fn new(touches: &WhiskerTouches) -> Self {
        let fit = touches.fit.as_ref().ok();
        let parameter = |fit: &TouchFit, parameter: Parameter| {
            let index = parameter.index();
            let deviation = fit.covariance[(index, index)].sqrt();
            MeasuredParameter { name: parameter.name(), difference: fit.parameters[index], deviation }
        };
        let parameters = |fit: &TouchFit| {
            Parameter::ALL[..Parameter::WHISKER].iter().map(|one| parameter(fit, *one)).collect::<Vec<_>>()
        };
        Self {
            whisker: touches.whisker.clone(),
            touches: touches.readings.len(),
            missed: touches.missed,
            time: touches.time,
            refusal: touches.fit.as_ref().err().map(ToString::to_string),
            tip_deviation_mm: fit.map(|_| 1e3 * touches.tip_deviation),
            chi_square: fit.map(|fit| fit.chi_square),
            parameters: fit.map(parameters).unwrap_or_default(),
            undetermined: fit.map(undetermined).unwrap_or_default(),
        }
    }
}

pub(super) fn calibrate_array(arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (mut scene, path) = match &arguments.rig {
        Some(path) => (load::scenario(path, &mut files)?.value, path.as_path()),
        None => (load::built_in_scenario(&SCENARIOS[0])?.value, Path::new(SCENARIOS[0].path)),
    };
    if arguments.noise {
        scene.rig.sensing.make_real();
    }
    let mismatch = arguments.mismatch.load(&mut files)?;
    mismatch.apply(&mut scene, &mut Sha256::default(), 0).map_err(Failure::mismatch(path))?;
    make_directory(arguments.out.as_deref())?;
    let outputs = arguments.out.as_ref().map(|directory| {
        let mut file = |name: &str| files.output("--out", &directory.join(format!("{name}.yaml")));
        scene.rig.whiskers.iter().map(|whisker| file(&whisker.name)).collect::<Result<Vec<_>, _>>()
    });
    let outputs = outputs.transpose()?;
    let world = arguments.world.of(&scene);
    let found = ArrayCalibration::run(&scene, world, arguments.seed, &TouchLimits::default())?;
    let documents: Vec<_> = found.whiskers.iter().map(MeasuredDocument::new).collect();
    output::documents(arguments.format, &documents, || [measured_table(&found.whiskers)])?;
    for document in &documents {
        if let Some(refusal) = &document.refusal {
            output::message(format_args!("{}: {refusal}", document.whisker));
        }
        for combination in &document.undetermined {
            output::message(format_args!("{}: not determined: {combination}", document.whisker));
        }
    }
    let Ok(calibrations) = found.calibrations() else { return Ok(Exit::Unexpected) };
    for (output, calibration) in outputs.into_iter().flatten().zip(&calibrations) {
        let path = output.path().to_owned();
        output.write(write_calibration(calibration))?;
        if !arguments.format.json {
            output::result(format_args!("calibration: {}", path.display()))?;
        }
    }
    Ok(Exit::Done)
}
