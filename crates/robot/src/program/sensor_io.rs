//! `vibrissa-robot sensor-io`

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;

use super::command_line::print_error;
use super::drive::{Error, read_config};
use super::event_log::EventLog;
use super::links::{actuator, broker, buses, poses, telemetry};
use super::machine_run::MachineRun;
use super::real_time::RealTime;
use super::service_threads::SensorIo;
use super::system_clock::SystemClock;
use super::watch::{termination, watch};
use crate::drive::RecordSink;
use crate::telemetry::Source;

const EXAMPLE: &str = "Example:\n  vibrissa-robot sensor-io --config /etc/vibrissa/array.yaml";

/// The arguments of `vibrissa-robot sensor-io`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct SensorIoArguments {
    /// Configuration of the robot, with an MQTT broker
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// End after this many seconds
    #[arg(long = "for", value_name = "SECONDS")]
    duration: Option<u64>,
}

pub(super) fn sensor_io(arguments: &SensorIoArguments) -> Result<ExitCode, Error> {
    let (config, _) = read_config(&arguments.config)?;
    let real_time = RealTime::request(|warning| print_error(&format!("warning: {warning}")));
    let clock = SystemClock::start();
    let (broker, termination) = (broker(&config)?.clone(), termination()?);
    let mut sinks: Vec<Box<dyn RecordSink>> = vec![Box::new(EventLog::new(None))];
    sinks.extend(telemetry(&config, Source::SensorIo, clock.now_ns())?);
    let (buses, actuator, poses) = (buses(&config, clock)?, actuator(&config)?, poses(&config)?);
    let threads = SensorIo { config, broker, buses, actuator, poses, sinks, clock }.start()?;
    print_error(&format!("sensor IO with {}", real_time.priority()));
    watch(threads, clock, &termination, arguments.duration.map(Duration::from_secs), &mut MachineRun::of_file())
}
