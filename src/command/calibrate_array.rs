//! `vibrissa calibrate --self` and `--touches`

use std::path::{Path, PathBuf};

use serde::Serialize;
use sha2::Sha256;
use vibrissa_runtime::calibration::{Parameter, TouchFit, TouchNoise};
use vibrissa_runtime::rig::{Rig, Whisker};

use super::calibrate::CalibrateArguments;
use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::provenance::provenance;
use super::trials::make_directory;
use vibrissa_lab::built_in::SCENARIOS;
use vibrissa_lab::calibration::{ArrayCalibration, TouchLimits, WhiskerTouches, undetermined, write_touches};
use vibrissa_lab::load::{self, LoadError, check_noise_seed};
use vibrissa_lab::report::measured_table;
use vibrissa_lab::results::Document;
use vibrissa_lab::trial::in_parallel;
use vibrissa_text::file::{CommandFiles, Output};
use vibrissa_world::scenario::write_calibration;
use vibrissa_world::scene::Scene;

/// The JSON output for one whisker.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct MeasuredDocument {
    whisker: String,
    /// Seed of the array, if it has a mismatch.
    mismatch_seed: Option<u64>,
    /// True if the true parameters but the offset are within the 95 % ellipsoid of the fit. `null` for a refused whisker and
    /// for measured touches.
    within_ellipsoid: Option<bool>,
    /// Number of touches, and of those in which the whisker slipped off.
    touches: usize,
    missed: usize,
    /// Duration (s). `null` for measured touches.
    time: Option<f64>,
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
    fn new(touches: &WhiskerTouches, mismatch_seed: Option<u64>, within_ellipsoid: Option<bool>) -> Self {
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
            mismatch_seed,
            within_ellipsoid,
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

/// Lets the array of a rig touch a pin in a simulator.
pub(super) fn calibrate_array(arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (mut scene, path) = scene(arguments, &mut files)?;
    if arguments.noise {
        scene.rig.sensing.make_real();
    }
    let mismatch = arguments.mismatch.load(&mut files)?;
    let mut first = scene.clone();
    mismatch.apply(&mut first, &mut Sha256::default(), 0).map_err(Failure::mismatch(&path))?;
    mismatch.check_effect(std::iter::once(&first)).map_err(LoadError::from)?;
    check_noise_seed(arguments.seed, std::iter::once(&first)).map_err(LoadError::from)?;
    let report = Report::new(arguments.out.as_deref(), &scene.rig, &mut files)?;
    let array = |number: &u64| -> Result<(Option<u64>, ArrayCalibration), Failure> {
        let mut scene = scene.clone();
        mismatch.apply(&mut scene, &mut Sha256::default(), *number).map_err(Failure::mismatch(&path))?;
        let (world, seed) = (arguments.world.of(&scene), arguments.seed.unwrap_or(0).wrapping_add(*number));
        let found = ArrayCalibration::run(&scene, world, seed, &TouchLimits::default())?;
        Ok((scene.mismatch.and_then(|mismatch| mismatch.seed), found))
    };
    let numbers: Vec<u64> = (0..arguments.arrays).collect();
    let found = in_parallel(&numbers, arguments.jobs.threads(), array, |_| ());
    let found = found.into_iter().collect::<Result<Vec<_>, Failure>>()?;
    let of_array = |(seed, found): &(Option<u64>, ArrayCalibration)| {
        let verdicts = found.whiskers.iter().zip(found.within());
        verdicts.map(|(touches, within)| MeasuredDocument::new(touches, *seed, within)).collect::<Vec<_>>()
    };
    let documents: Vec<_> = found.iter().flat_map(of_array).collect();
    let whiskers: Vec<_> = found.into_iter().flat_map(|(_, found)| found.whiskers).collect();
    let exit = report.show(&whiskers, &documents, arguments)?;
    if arguments.arrays > 1 && !arguments.format.json {
        let accepted = documents.iter().filter(|document| document.refusal.is_none()).count();
        let within = documents.iter().filter(|document| document.within_ellipsoid == Some(true)).count();
        output::result(format_args!(
            "{accepted} of {} whiskers are accepted; the 95 % ellipsoid has the true parameters of {within} of them",
            documents.len()
        ))?;
    }
    Ok(exit)
}

/// Fits the whiskers of a rig to the measured touches in the file at `path`.
pub(super) fn calibrate_touches(path: &Path, arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let rig = scene(arguments, &mut files)?.0.rig;
    let touches = load::touches(path, &mut files)?;
    let names: Vec<_> = touches.iter().map(|(name, _)| name.clone()).collect();
    rig.indices(&names).map_err(Failure::NoWhisker)?;
    let report = Report::new(arguments.out.as_deref(), &rig, &mut files)?;
    let noise = TouchNoise { position: arguments.position_noise, heading: arguments.heading_noise };
    let fitted = |(index, whisker): (usize, &Whisker)| {
        let of_whisker = touches.iter().filter(|(name, _)| *name == whisker.name);
        let readings: Vec<_> = of_whisker.map(|(_, touch)| *touch).collect();
        (!readings.is_empty()).then(|| WhiskerTouches::fitted(&rig, index, readings, noise))
    };
    let found: Vec<_> = rig.whiskers.iter().enumerate().filter_map(fitted).collect();
    let documents: Vec<_> = found.iter().map(|touches| MeasuredDocument::new(touches, None, None)).collect();
    report.show(&found, &documents, arguments)
}

/// The scene with the rig, and its path. Its whiskers have no calibration.
pub(super) fn scene(arguments: &CalibrateArguments, files: &mut CommandFiles) -> Result<(Scene, PathBuf), Failure> {
    let (mut scene, path) = match &arguments.rig {
        Some(path) => (load::scenario(path, files)?.value, path.clone()),
        None => (load::built_in_scenario(&SCENARIOS[0])?.value, SCENARIOS[0].path.into()),
    };
    for whisker in &mut scene.rig.whiskers {
        whisker.calibration = None;
    }
    Ok((scene, path))
}

/// The files for the calibrations of all whiskers, and for their touches.
struct Report {
    calibrations: Vec<(String, Output)>,
    touches: Option<Output>,
}

impl Report {
    fn new(directory: Option<&Path>, rig: &Rig, files: &mut CommandFiles) -> Result<Self, Failure> {
        make_directory(directory)?;
        let Some(directory) = directory else { return Ok(Self { calibrations: Vec::new(), touches: None }) };
        let file = |whisker: &Whisker| -> Result<(String, Output), Failure> {
            let path = directory.join(format!("{}.yaml", whisker.name));
            Ok((whisker.name.clone(), files.output("--out", &path)?))
        };
        let calibrations = rig.whiskers.iter().map(file).collect::<Result<_, _>>()?;
        Ok(Self { calibrations, touches: Some(files.output("--out", &directory.join("touches.csv"))?) })
    }

    /// Prints the results, and writes the calibrations unless a whisker is refused. The touches are written in any case.
    fn show<'t>(
        self,
        found: &'t [WhiskerTouches],
        documents: &[MeasuredDocument],
        arguments: &CalibrateArguments,
    ) -> Result<Exit, Failure> {
        output::documents(arguments.format, &provenance(), documents, || [measured_table(found)])?;
        for document in documents {
            if let Some(refusal) = &document.refusal {
                output::message(format_args!("{}: {refusal}", document.whisker));
            }
            for combination in &document.undetermined {
                output::message(format_args!("{}: not determined: {combination}", document.whisker));
            }
        }
        if let Some(file) = self.touches {
            let of_whisker = |touches: &'t WhiskerTouches| {
                touches.readings.iter().map(|reading| (touches.whisker.as_str(), reading))
            };
            file.write(write_touches(found.iter().flat_map(of_whisker))?)?;
        }
        let calibrations = found.iter().map(WhiskerTouches::calibration).collect::<Result<Vec<_>, _>>();
        let Ok(calibrations) = calibrations else { return Ok(Exit::Unexpected) };
        for (name, file) in self.calibrations {
            let fitted = found.iter().zip(&calibrations).find(|(touches, _)| touches.whisker == name);
            let Some((_, calibration)) = fitted else { continue };
            let path = file.path().to_owned();
            file.write(write_calibration(calibration))?;
            if !arguments.format.json {
                output::result(format_args!("calibration: {}", path.display()))?;
            }
        }
        Ok(Exit::Done)
    }
}
