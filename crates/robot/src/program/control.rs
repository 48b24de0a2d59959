//! `vibrissa-robot control`

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use vibrissa_runtime::control::Control;

use super::command_line::print_error;
use super::drive::{Error, read_config, read_machine};
use super::event_log::EventLog;
use super::links::{broker, telemetry};
use super::machine_run::MachineRun;
use super::measure::measured;
use super::real_time::RealTime;
use super::recorder::recorder;
use super::service_threads::Controller;
use super::system_clock::SystemClock;
use super::watch::{termination, watch};
use crate::admission::{Admission, Device, admit};
use crate::drive::RecordSink;
use crate::services::controller_config;
use crate::telemetry::Source;

const EXAMPLE: &str = "Example:\n  vibrissa-robot control thesis.machine --config /etc/vibrissa/array.yaml";

/// The arguments of `vibrissa-robot control`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ControlArguments {
    /// Compiled machine
    #[arg(value_name = "MACHINE")]
    machine: PathBuf,
    /// Configuration of the robot, with an MQTT broker
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// End after this many seconds
    #[arg(long = "for", value_name = "SECONDS")]
    duration: Option<u64>,
    /// Start without the measurement of this computer
    #[arg(long)]
    skip_admission: bool,
}

pub(super) fn control(arguments: &ControlArguments) -> Result<ExitCode, Error> {
    let (config, config_text) = read_config(&arguments.config)?;
    let broker = broker(&config)?.clone();
    let artifact = read_machine(&arguments.machine)?;
    let program = Arc::new(artifact.program.clone());
    if let Some(age) = program.needs.sample_age {
        let age = age * 1e3;
        return Err(format!(
            "the policy needs samples of at most {age} ms, and a network does not ensure this; use `vibrissa-robot drive`"
        )
        .into());
    }
    let real_time = RealTime::request(|warning| print_error(&format!("warning: {warning}")));
    let clock = SystemClock::start();
    let control = Control::new(&config.rig, Arc::clone(&program))?;
    let Admission { slower, .. } = if arguments.skip_admission {
        admit(&artifact, &config, &mut Device::instant())?
    } else {
        // The buses are those of the sensor IO.
        measured(&control, &config.rig, Vec::new(), clock, |device| admit(&artifact, &config, device))?
    };
    if let Some(slower) = slower {
        return Err(format!("{slower}; set these rates in the configuration of both services").into());
    }
    let config = controller_config(&config);
    let termination = termination()?;
    let mut sinks: Vec<Box<dyn RecordSink>> = vec![Box::new(EventLog::new(Some(Arc::clone(&program))))];
    let recorder = recorder(&config, config_text, &artifact)?;
    sinks.extend(recorder.map(|recorder| Box::new(recorder) as Box<dyn RecordSink>));
    sinks.extend(telemetry(&config, Source::Controller(&program), clock.now_ns())?);
    let threads = Controller { config, broker, control, sinks, clock }.start()?;
    print_error(&format!("controlling by {} with {}", program.name, real_time.priority()));
    watch(threads, clock, &termination, arguments.duration.map(Duration::from_secs), &mut MachineRun::of_file())
}
