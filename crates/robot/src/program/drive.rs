//! `vibrissa-robot drive`

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{ARTIFACT_LIMIT, Artifact};
use vibrissa_text::system::in_words;

use super::command_line::print_error;
use super::event_log::EventLog;
use super::links::{actuator, buses, poses, telemetry};
use super::machine_run::MachineRun;
use super::measure::measured;
use super::real_time::RealTime;
use super::recorder::recorder;
use super::system_bus::SystemBus;
use super::system_clock::SystemClock;
use super::threads::Robot;
use super::watch::{termination, watch};
use crate::admission::{Admission, Device, admit};
use crate::config::{CONFIG_LIMIT, Config};
use crate::drive::RecordSink;
use crate::sensor::{BusClock, Sensor};
use crate::store::{DEFAULT_KEYS, DEFAULT_STORE, Keys, Store};
use crate::telemetry::Source;

const EXAMPLE: &str = "Examples:\n  vibrissa-robot drive --config /etc/vibrissa/array.yaml\n  \
                       vibrissa-robot drive thesis.machine --config /etc/vibrissa/array.yaml";
/// The default time without a stop after which a tentative machine is good.
const GOOD_AFTER_S: u32 = 60;

/// The arguments of `vibrissa-robot drive`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct DriveArguments {
    /// Compiled machine. By default, the tentative or good machine of the store
    #[arg(value_name = "MACHINE")]
    machine: Option<PathBuf>,
    /// Configuration of the robot
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// End after this many seconds
    #[arg(long = "for", value_name = "SECONDS")]
    duration: Option<u64>,
    /// Start without the measurement of the device
    #[arg(long)]
    skip_admission: bool,
    /// Directory of the store
    #[arg(long, value_name = "DIR", default_value = DEFAULT_STORE, conflicts_with = "machine")]
    store: PathBuf,
    /// Directory of the trusted public keys, with which a machine of the store is verified again. By default
    /// /etc/vibrissa/keys, if there is one
    #[arg(long, value_name = "DIR", conflicts_with = "machine")]
    keys: Option<PathBuf>,
    /// Mark a tentative machine good after this many seconds without a stop
    #[arg(long, value_name = "SECONDS", default_value_t = GOOD_AFTER_S, conflicts_with = "machine",
        value_parser = clap::value_parser!(u32).range(1..))]
    good_after: u32,
}

/// An error of the program.
pub(super) type Error = Box<dyn std::error::Error>;

pub(super) fn drive(arguments: &DriveArguments) -> Result<ExitCode, Error> {
    let (config, config_text) = read_config(&arguments.config)?;
    let (artifact, mut run) = match &arguments.machine {
        Some(path) => (read_machine(path)?, MachineRun::of_file()),
        None => MachineRun::of_store(store(arguments, &config.name)?)?,
    };
    let result = drive_by(&artifact, &mut run, &config, config_text, arguments);
    run.end();
    result
}

/// The store of the robot, with the keys that it trusts.
fn store(arguments: &DriveArguments, name: &str) -> Result<Store, Error> {
    let store = Store::open(&arguments.store)?.of_robot(name);
    let usual = Path::new(DEFAULT_KEYS);
    let keys = arguments.keys.as_deref().or_else(|| usual.exists().then_some(usual));
    let Some(keys) = keys else { return Ok(store) };
    match Keys::from_folder(keys) {
        Ok(keys) => Ok(store.trusting(keys)),
        // Without a machine, the keys do not matter, and the service must end with the status for that.
        Err(_) if store.status()?.current().is_none() => Ok(store),
        Err(error) => Err(error.into()),
    }
}

fn drive_by(
    artifact: &Artifact,
    run: &mut MachineRun,
    config: &Config,
    config_text: String,
    arguments: &DriveArguments,
) -> Result<ExitCode, Error> {
    let program = Arc::new(artifact.program.clone());
    let real_time = RealTime::request(|warning| print_error(&format!("warning: {warning}")));
    let clock = SystemClock::start();
    let control = Control::new(&config.rig, Arc::clone(&program)).inspect_err(|error| run.note_failure(error))?;
    let admission = if arguments.skip_admission {
        admit(artifact, config, &mut Device::instant())
    } else {
        let clocks = bus_clocks(config, clock)?;
        measured(&control, &config.rig, clocks, clock, |device| admit(artifact, config, device))
    };
    let Admission { config, slower } = admission.inspect_err(|refusal| {
        if refusal.concerns_machine() {
            run.note_failure(refusal);
        }
    })?;
    if let Some(slower) = slower {
        print_error(&format!("warning: {slower}"));
    }
    let control = Control::new(&config.rig, Arc::clone(&program))?;
    let recorder = recorder(&config, config_text, artifact)?;
    let termination = termination()?;
    let buses = buses(&config, clock)?;
    let (actuator, poses) = (actuator(&config)?, poses(&config)?);
    let mut sinks: Vec<Box<dyn RecordSink>> = vec![Box::new(EventLog::new(Some(Arc::clone(&program))))];
    sinks.extend(run.good_after(ticks(arguments.good_after, config.rig.sensing.control_rate)));
    sinks.extend(recorder.map(|recorder| Box::new(recorder) as Box<dyn RecordSink>));
    // It is last, because its end takes longest.
    sinks.extend(telemetry(&config, Source::Loop(&program), clock.now_ns())?);
    let robot = Robot { config, control, buses, actuator, poses, sinks, clock };
    let threads = robot.start()?;
    print_error(&format!("driving by {} with {}", program.name, real_time.priority()));
    watch(threads, clock, &termination, arguments.duration.map(Duration::from_secs), run)
}

/// The configuration and its text.
pub(super) fn read_config(path: &Path) -> Result<(Config, String), Error> {
    let bytes = read(path, CONFIG_LIMIT)?;
    let text = String::from_utf8(bytes).map_err(|_| format!("{} is not UTF-8 text", path.display()))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut calibration = |name: &str| read(&folder.join(name), CONFIG_LIMIT).map_err(|error| error.to_string());
    let config =
        Config::from_text_with(&text, &mut calibration).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok((config, text))
}

pub(super) fn read_machine(path: &Path) -> Result<Artifact, Error> {
    let bytes = read(path, ARTIFACT_LIMIT)?;
    Ok(Artifact::from_bytes(&bytes).map_err(|error| format!("{}: {error}", path.display()))?)
}

/// Number of control ticks in a time (s).
fn ticks(seconds: u32, control_rate: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    let ticks = (f64::from(seconds) * control_rate).ceil() as u64;
    ticks
}

#[expect(clippy::disallowed_methods, reason = "the size is bounded below")]
fn read(path: &Path, limit: usize) -> Result<Vec<u8>, Error> {
    use std::io::Read;
    let cannot = |error: std::io::Error| format!("cannot read {}: {}", path.display(), in_words(&error));
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(cannot)?;
    file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() > limit {
        return Err(format!("{} is larger than {limit} bytes; it is probably another file", path.display()).into());
    }
    Ok(bytes)
}

/// Measures the clock of every bus at its first board.
fn bus_clocks(config: &Config, clock: SystemClock) -> Result<Vec<BusClock>, Error> {
    let sensor = config.sensor()?;
    let measure = |bus: &crate::config::BusConfig| {
        let mut opened = SystemBus::open(&bus.device, clock)?;
        let board = bus.boards.first().ok_or("a bus has no board")?;
        let measured = sensor.bus_clock(&mut opened, board.address, || clock.now_ns());
        measured.map_err(|error| Error::from(format!("{}: {error}", bus.device.display())))
    };
    config.buses.iter().map(measure).collect()
}
