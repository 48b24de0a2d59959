//! `vibrissa-robot drive`

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use clap::Args;
use vibrissa_mlx90393::{Address, measure_bus_clock};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{ARTIFACT_LIMIT, Artifact, Program};

use super::command_line::print_error;
use super::event_log::EventLog;
use super::machine_run::MachineRun;
use super::measure::measured;
use super::real_time::RealTime;
use super::recorder::recorder;
use super::system_bus::SystemBus;
use super::system_clock::SystemClock;
use super::threads::{PoseReceiver, Robot, ThreadError, Threads};
use crate::admission::{Admission, Device, admit};
use crate::config::{ActuatorConfig, CONFIG_LIMIT, Config, MqttConfig, PoseSource};
use crate::drive::RecordSink;
use crate::histogram::Histogram;
use crate::link::{Actuator, DryRun, MqttActuator, MqttPoses, UdpActuator, UdpPoses};
use crate::store::DEFAULT_STORE;
use crate::telemetry::{Publisher, TelemetrySink};
use crate::vitals::{Phase, Vitals};

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
    /// Mark a tentative machine good after this many seconds without a stop
    #[arg(long, value_name = "SECONDS", default_value_t = GOOD_AFTER_S, conflicts_with = "machine",
        value_parser = clap::value_parser!(u32).range(1..))]
    good_after: u32,
}

/// An error of the program.
pub(super) type Error = Box<dyn std::error::Error>;

/// Time between looks at the threads.
const LOOK: Duration = Duration::from_millis(20);
/// Age (ns) of a sign of life up to which the watchdog of the system is fed.
const ALIVE_NS: u64 = 500_000_000;
/// Time for stop commands at the end.
const FAREWELL: Duration = Duration::from_millis(100);
/// The longest wait for a pose.
const POSE_WAIT: Duration = Duration::from_millis(10);

pub(super) fn drive(arguments: &DriveArguments) -> Result<ExitCode, Error> {
    let (config, config_text) = read_config(&arguments.config)?;
    let (artifact, mut run) = match &arguments.machine {
        Some(path) => (read_machine(path)?, MachineRun::of_file()),
        None => MachineRun::of_store(&arguments.store)?,
    };
    let result = drive_by(&artifact, &mut run, &config, config_text, arguments);
    run.end();
    result
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
    let termination = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&termination))?;
    }
    let mut buses: Vec<Box<dyn FnOnce() -> SystemBus + Send>> = Vec::new();
    for bus in &config.buses {
        let opened = SystemBus::open(&bus.device, clock)?;
        buses.push(Box::new(move || opened));
    }
    let (actuator, poses) = (actuator(&config)?, poses(&config)?);
    let mut sinks: Vec<Box<dyn RecordSink>> = vec![Box::new(EventLog::new(Arc::clone(&program)))];
    sinks.extend(run.good_after(ticks(arguments.good_after, config.rig.sensing.control_rate)));
    sinks.extend(recorder.map(|recorder| Box::new(recorder) as Box<dyn RecordSink>));
    // It is last, because its end takes longest.
    sinks.extend(telemetry(&config, &program)?);
    let robot = Robot { config, control, buses, actuator, poses, sinks, clock };
    let threads = robot.start()?;
    print_error(&format!(
        "driving by {} with {}",
        program.name,
        if real_time.has_priority { "real-time priority" } else { "ordinary priority" }
    ));
    watch(threads, clock, &termination, arguments.duration.map(Duration::from_secs), run)
}

/// Looks after the threads until the end, feeds the watchdog of the system, and logs faults.
fn watch(
    threads: Threads,
    clock: SystemClock,
    termination: &AtomicBool,
    duration: Option<Duration>,
    run: &mut MachineRun,
) -> Result<ExitCode, Error> {
    let _ = sd_notify::notify(&[sd_notify::NotifyState::Ready]);
    let end_ns = duration.map(|duration| u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX));
    let mut error = None;
    loop {
        std::thread::sleep(LOOK);
        if let Ok(cause) = threads.errors.try_recv() {
            error = Some(cause);
            break;
        }
        if termination.load(Ordering::Acquire) || end_ns.is_some_and(|end_ns| clock.now_ns() >= end_ns) {
            break;
        }
        if is_alive(&threads, clock.now_ns()) {
            let _ = sd_notify::notify(&[sd_notify::NotifyState::Watchdog]);
        }
    }
    for line in summary(&threads.vitals, threads.buses) {
        print_error(&line);
    }
    let has_ended = threads.vitals.has_machine_failed.load(Ordering::Acquire)
        || threads.vitals.has_panicked.load(Ordering::Acquire);
    match &error {
        Some(cause @ ThreadError::Machine(_)) => run.note_failure(cause),
        _ if has_ended => run.note_failure("the program has failed during its run"),
        _ if threads.vitals.is_running.load(Ordering::Acquire) => run.note_executed(),
        _ => {}
    }
    let _ = sd_notify::notify(&[sd_notify::NotifyState::Stopping]);
    threads.terminate();
    std::thread::sleep(FAREWELL);
    threads.end();
    match error {
        Some(cause @ ThreadError::Machine(_)) => {
            print_error(&cause.to_string());
            Ok(ExitCode::from(1))
        }
        Some(cause) => Err(cause.into()),
        None if has_ended => Ok(ExitCode::from(1)),
        None => Ok(ExitCode::SUCCESS),
    }
}

/// True if every thread has given a sign of life. The watchdog is fed only then.
fn is_alive(threads: &Threads, now_ns: u64) -> bool {
    let vitals = &threads.vitals;
    if !vitals.is_running.load(Ordering::Acquire) {
        return true;
    }
    let is_recent =
        |last: &std::sync::atomic::AtomicU64| now_ns.saturating_sub(last.load(Ordering::Acquire)) < ALIVE_NS;
    let buses = vitals.round_ns.iter().take(threads.buses);
    buses.chain([&vitals.tick_ns, &vitals.supervised_ns]).all(is_recent)
}

/// The timing of the run: one line for each histogram, and the missed periods.
fn summary(vitals: &Vitals, buses: usize) -> Vec<String> {
    let microseconds = |ns: u64| ns as f64 * 1e-3;
    let line = |name: String, histogram: &Histogram| {
        let quantile = |share| histogram.quantile_ns(share).map_or(0.0, microseconds);
        format!(
            "{name}: median {:.0} µs, 99 % below {:.0} µs, at most {:.0} µs",
            quantile(0.5),
            quantile(0.99),
            microseconds(histogram.largest_ns())
        )
    };
    let rounds = vitals.round_time.iter().take(buses).enumerate();
    let mut lines: Vec<String> = rounds.map(|(bus, time)| line(format!("round on bus {bus}"), time)).collect();
    lines.push(line("tick".to_owned(), &vitals.tick_time));
    lines.push(line("lateness of ticks".to_owned(), &vitals.tick_lateness));
    lines.push(line("age of the newest sample".to_owned(), &vitals.sample_age));
    let missed: Vec<String> =
        Phase::ALL.iter().map(|&phase| format!("{} {}", phase.name(), vitals.missed(phase))).collect();
    lines.push(format!("missed periods: {}", missed.join(", ")));
    lines
}

/// The configuration and its text.
pub(super) fn read_config(path: &Path) -> Result<(Config, String), Error> {
    let bytes = read(path, CONFIG_LIMIT)?;
    let text = String::from_utf8(bytes).map_err(|_| format!("{} is not UTF-8 text", path.display()))?;
    let config = Config::from_text(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok((config, text))
}

fn read_machine(path: &Path) -> Result<Artifact, Error> {
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
    let cannot = |error: std::io::Error| format!("cannot read {}: {error}", path.display());
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(cannot)?;
    file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() > limit {
        return Err(format!("{} is larger than {limit} bytes; it is probably another file", path.display()).into());
    }
    Ok(bytes)
}

/// Measures the clock of every bus at its first board.
fn bus_clocks(config: &Config, clock: SystemClock) -> Result<Vec<vibrissa_mlx90393::BusClock>, Error> {
    let measure = |bus: &crate::config::BusConfig| {
        let mut opened = SystemBus::open(&bus.device, clock)?;
        let board = bus.boards.first().ok_or("a bus has no board")?;
        let address = Address::new(board.address)?;
        let measured = measure_bus_clock(&mut opened, address, || clock.now_ns());
        measured.map_err(|error| Error::from(format!("{}: {error}", bus.device.display())))
    };
    config.buses.iter().map(measure).collect()
}

fn actuator(config: &Config) -> Result<Box<dyn Actuator>, Error> {
    Ok(match config.actuator {
        ActuatorConfig::DryRun => Box::new(DryRun),
        ActuatorConfig::Udp { address, acknowledged } => Box::new(UdpActuator::new(address, acknowledged)?),
        ActuatorConfig::Mqtt { acknowledged } => {
            Box::new(MqttActuator::new(&config.name, broker(config)?, acknowledged)?)
        }
    })
}

fn poses(config: &Config) -> Result<PoseReceiver, Error> {
    Ok(match config.pose.source {
        PoseSource::Udp { listen } => {
            let mut poses = UdpPoses::new(listen, POSE_WAIT)?;
            Box::new(move || poses.receive().map(|packet| packet.pose))
        }
        PoseSource::Mqtt {} => {
            let mut poses = MqttPoses::new(&config.name, broker(config)?)?;
            Box::new(move || poses.receive(POSE_WAIT).map(|packet| packet.pose))
        }
    })
}

fn broker(config: &Config) -> Result<&MqttConfig, Error> {
    Ok(config.mqtt.as_ref().ok_or("the configuration has no MQTT broker; add `mqtt: {host: ...}`")?)
}

/// The receiver of records that publishes them, if there is a broker.
fn telemetry(config: &Config, program: &Program) -> Result<Option<Box<dyn RecordSink>>, Error> {
    let Some(mqtt) = &config.mqtt else { return Ok(None) };
    let publisher = Publisher::start(&config.name, mqtt, print_error)?;
    Ok(Some(Box::new(TelemetrySink::new(config, program, publisher))))
}
