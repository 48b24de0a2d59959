//! `vibrissa drive`

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::{Arg, Args};
use vibrissa_robot::admission::{Admission, Device, admit};
use vibrissa_robot::config::Config;
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::{Injection, Settings as EmulationSettings};

use super::exit::Exit;
use super::failure::Failure;
#[cfg(feature = "live")]
use super::live::{LivePage, REAL_TIME, begin, serve_on};
use super::options::{Format, WorldOptions};
use super::output;
use super::provenance::of_trials;
use super::run_recording::RunRecording;
use super::trials::{ReportFiles, make_directory, report_events, report_violations};
use super::values::parse_seed;
#[cfg(feature = "live")]
use crate::live::RunSetup;
use vibrissa_lab::emulated::{self, EmulatedResult};
use vibrissa_lab::load::{self, GivenMismatch, LoadError, Loaded};
use vibrissa_lab::report::{Table, faults_table, results_table};
use vibrissa_lab::results::{DriveResult, UndetectedFault};
use vibrissa_lab::trial::{Inputs, Trial};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{Outcome, Scene};

const EXAMPLE: &str = "Example:\n  vibrissa compile policies/thesis.fsm --out thesis.machine\n  vibrissa drive thesis.machine --emulate scenarios/box.yaml\n\nOn the robot:\n  vibrissa drive thesis.machine --config /etc/vibrissa/array.yaml\n\nExit status: 0 done and all expectations held; 1 an expectation failed, or a fault stopped the robot; 2 unusable input; 3 internal error; 130 interrupted.";

/// The program that drives the real array.
#[cfg(unix)]
const ROBOT: &str = "vibrissa-robot";

/// The arguments of `vibrissa drive`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE, mut_args(only_emulated))]
pub(super) struct DriveArguments {
    /// Compiled machine. With --emulate, also a policy
    #[arg(value_name = "MACHINE")]
    machine: PathBuf,
    /// Scenario whose rig is driven in a simulation, with emulated sensors on emulated buses. Without this option, the
    /// program `vibrissa-robot` drives the real array
    #[arg(long, value_name = "SCENARIO", required_unless_present = "config")]
    emulate: Option<PathBuf>,
    /// Configuration of the array, such as deploy/pi/array.yaml. Its rig replaces that of the scenario. By default, a
    /// configuration is made for the scenario's rig
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Faults to inject: a list in YAML with the time, the duration, the kind and the part of each
    #[arg(long, value_name = "FILE")]
    inject: Option<PathBuf>,
    /// Standard deviation of the noise of the emulated sensors in microtesla
    #[arg(long, value_name = "UT", default_value_t = EmulationSettings::default().noise_microtesla)]
    sensor_noise: f64,
    /// Seed of the noise of the emulated sensors. Overrides the seed of the scenario
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_seed)]
    seed: Option<u64>,
    #[command(flatten)]
    world: WorldOptions,
    /// Let control assume the rig of the scenario. By default, an array with a mismatch first calibrates itself by touches of a pin. A
    /// configuration has its own calibrations
    #[arg(long, conflicts_with = "config")]
    uncalibrated: bool,
    /// Record the run into this MCAP file, for `vibrissa inspect keep` and `vibrissa replay`
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Write a picture and the result into this directory
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[cfg(feature = "live")]
    #[command(flatten)]
    live: LivePage,
    #[command(flatten)]
    format: Format,
}

/// The options that describe a simulation have no meaning without one.
fn only_emulated(argument: Arg) -> Arg {
    match argument.get_id().as_str() {
        "machine" | "emulate" | "config" => argument,
        _ => argument.requires("emulate"),
    }
}

pub(super) fn drive(arguments: &DriveArguments) -> Result<Exit, Failure> {
    match &arguments.emulate {
        Some(scenario) => emulate(arguments, scenario),
        None => Err(Failure::NoRobotProgram(become_robot(arguments))),
    }
}

/// Replaces this process by the program of the robot, so that signals reach it. The result is the reason why there is none.
#[cfg(unix)]
fn become_robot(arguments: &DriveArguments) -> std::io::Error {
    use std::os::unix::process::CommandExt;
    let mut program = std::process::Command::new(ROBOT);
    program.arg("drive");
    if let Some(config) = &arguments.config {
        program.arg("--config").arg(config);
    }
    program.arg("--").arg(&arguments.machine).exec()
}

#[cfg(not(unix))]
fn become_robot(_: &DriveArguments) -> std::io::Error {
    std::io::ErrorKind::Unsupported.into()
}

/// The configuration of the rig of a scene, whose array is calibrated first.
fn emulated_config(
    arguments: &DriveArguments,
    scene: &mut Scene,
    scenario: &Path,
    settings: &EmulationSettings,
) -> Result<Config, Failure> {
    let array = GivenMismatch::read(None, None, &mut CommandFiles::new())?.uncalibrated(arguments.uncalibrated);
    array.check_effect(std::iter::once(&*scene)).map_err(LoadError::from)?;
    let world = arguments.world.of(scene);
    array.calibrate_scene(scene, world).map_err(Failure::calibration(scenario))?;
    Ok(Config::emulated(scene.rig.clone(), settings.noise_microtesla))
}

fn emulate(arguments: &DriveArguments, scenario: &Path) -> Result<Exit, Failure> {
    let before = Instant::now();
    let mut files = CommandFiles::new();
    let source = load::scenario_text(scenario, &mut files)?;
    let Loaded { value: mut scene, hash: scenario_hash } = load::scenario_in(&source, &mut files)?;
    let policy = load::policy(&arguments.machine, &mut files)?;
    output::warnings(&policy.value);
    let mut settings = EmulationSettings {
        seed: arguments.seed.unwrap_or(scene.seed),
        noise_microtesla: arguments.sensor_noise,
        injections: Vec::new(),
    };
    let (config, config_text) = match &arguments.config {
        Some(path) => {
            let (config, text) = config(path, &mut files)?;
            scene.rig = config.rig.clone();
            (config, Some(text))
        }
        None => (emulated_config(arguments, &mut scene, scenario, &settings)?, None),
    };
    if let Some(path) = &arguments.inject {
        settings.injections = injections(path, &config, scene.stop.time, &mut files)?;
    }
    #[cfg(feature = "live")]
    let text = policy.value.text.map(|text| text.source);
    let artifact = policy.value.artifact;
    let admission = admit(&artifact, &config, &mut Device::instant());
    let Admission { config, slower } = admission.map_err(Failure::at(&arguments.machine))?;
    if let Some(slower) = slower {
        output::message(format_args!("warning: {slower}"));
    }
    let report = match &arguments.out {
        Some(directory) => {
            make_directory(Some(directory))?;
            Some(ReportFiles::new(&directory.join(&scene.name), &mut files)?)
        }
        None => None,
    };
    let world = arguments.world.of(&scene);
    let inputs = Inputs::new(scenario, scenario_hash, policy.hash);
    let mut recording = match &arguments.record {
        Some(path) => {
            let details = BTreeMap::from([
                ("scenario".to_owned(), scene.name.clone()),
                ("scenario_hash".to_owned(), inputs.scenario_hash.clone()),
                ("seed".to_owned(), settings.seed.to_string()),
            ]);
            Some(RunRecording::new(path, &config, config_text, &artifact, details, &mut files)?)
        }
        None => None,
    };
    let program = Arc::new(artifact.program);
    let trial = Trial { world, seed: settings.seed, ..Trial::new(scene, program) };
    output::calibrations(trial.calibration().iter());
    let trial = Trial { inputs: Inputs { preparation: before.elapsed(), ..inputs }, ..trial };
    let record = |entry: &LoopRecord| recording.iter_mut().for_each(|recording| recording.take(entry));
    #[cfg(feature = "live")]
    let live = arguments.live.start(REAL_TIME, &[])?;
    #[cfg(feature = "live")]
    let page = |live| begin(live, RunSetup::emulated(&trial, &config.rig, text), || false);
    #[cfg(feature = "live")]
    let mut page = live.as_ref().map(page).transpose()?;
    #[cfg(not(feature = "live"))]
    let mut page = ();
    let emulated = emulated::run(&trial, &config, &settings, record, &mut page).map_err(|cause| {
        // With a configuration, the rig is that of its file.
        Failure::at(arguments.config.as_ref().unwrap_or(&trial.inputs.scenario))(cause)
    })?;
    #[cfg(feature = "live")]
    if let Some(page) = page {
        page.finish(&emulated.result);
    }
    if let Some(recording) = recording {
        recording.finish()?;
    }
    let document = trial.document(&emulated.result);
    report_events(&document);
    report_violations(&trial.scene.name, &emulated.result);
    let exit = if emulated.result.violations.is_empty() { Exit::Done } else { Exit::Unexpected };
    let provenance = of_trials([&trial]);
    if let Some(report) = report {
        report.write(&provenance, &trial, &emulated.result, &document)?;
    }
    let undetected = undetected(&settings.injections, &emulated);
    let result = DriveResult::new(document, &emulated.events, emulated.begun_ns, emulated.missed, &undetected);
    for UndetectedFault { kind, part, at_s } in &result.undetected {
        output::message(format_args!(
            "warning: the fault {kind} of part {part}, injected at {at_s} s, was not detected: it had no effect, or the run had ended"
        ));
    }
    output::document(arguments.format, &provenance, &result, || tables(&result))?;
    #[cfg(feature = "live")]
    if let Some(live) = live {
        serve_on(&live);
    }
    Ok(exit)
}

/// The faults that neither the supervisor nor the policy has noticed. A policy notices a fault if it fails during it.
fn undetected(injections: &[Injection], emulated: &EmulatedResult) -> Vec<Injection> {
    let EmulatedResult { result, events, begun_ns, ended_ns, .. } = emulated;
    let has_failed = result.run.outcome == Outcome::Failed;
    let noticed =
        |it: &&Injection| it.was_detected(events, *begun_ns) || (has_failed && it.may_cause(*ended_ns, *begun_ns));
    injections.iter().filter(|it| !noticed(it)).copied().collect()
}

/// The figures of the run, and its faults if there are any.
fn tables(result: &DriveResult) -> Vec<Table> {
    let faults = (!result.faults.is_empty()).then(|| faults_table(&result.faults));
    std::iter::once(results_table(std::slice::from_ref(&result.run))).chain(faults).collect()
}

/// Reads a configuration. The result has its text too.
pub(super) fn config(path: &Path, files: &mut CommandFiles) -> Result<(Config, String), Failure> {
    let text = load::read(path, files)?.text;
    let mut calibration = |name: &str| load::outline_file(&load::beside(path, name), files);
    let config = Config::from_text_with(&text, &mut calibration).map_err(Failure::at(path))?;
    Ok((config, text))
}

/// Time (s) without a fault after which a robot goes on. It is more than the longest one of a configuration.
const RESUMED: f64 = 61.0;

/// Reads a list of faults for a robot, in a run of at most `time` (s).
fn injections(path: &Path, config: &Config, time: f64, files: &mut CommandFiles) -> Result<Vec<Injection>, Failure> {
    let text = load::read(path, files)?;
    let injections = Injection::list(&text.text, config).map_err(Failure::at(path))?;
    if injections.is_empty() {
        return Err(Failure::at(path)("the list has no fault; write one, or leave out `--inject`"));
    }
    let seconds = |milliseconds: u64| milliseconds as f64 * 1e-3;
    for (index, injection) in injections.iter().enumerate() {
        // Faults before it make the run longer.
        let others =
            injections.iter().enumerate().filter(|(other, before)| *other != index && before.at_ms <= injection.at_ms);
        let latest = time + others.map(|(_, before)| seconds(before.for_ms) + RESUMED).sum::<f64>();
        if seconds(injection.at_ms) >= latest {
            let at = seconds(injection.at_ms);
            return Err(Failure::at(path)(format!(
                "the fault {} would begin at {at} s, and the run ends after {latest} s at the latest; give an earlier `at_ms`, \
                 or a later `stop: {{time: ...}}` of the scenario",
                index + 1
            )));
        }
    }
    Ok(injections)
}
