//! The buses and links that a configuration names.

use std::time::Duration;

use super::command_line::print_error;
use super::drive::Error;
use super::system_bus::SystemBus;
use super::system_clock::SystemClock;
use super::threads::{OpenBus, PoseReceiver};
use crate::config::{ActuatorConfig, Config, MqttConfig, PoseSource};
use crate::drive::RecordSink;
use crate::link::{Actuator, DryRun, MqttActuator, MqttPoses, UdpActuator, UdpPoses};
use crate::telemetry::{Publisher, Source, TelemetrySink};

/// The longest wait for a pose.
const POSE_WAIT: Duration = Duration::from_millis(10);

/// Opens all buses.
pub(super) fn buses(config: &Config, clock: SystemClock) -> Result<Vec<OpenBus<SystemBus>>, Error> {
    let open = |bus: &crate::config::BusConfig| {
        let opened = SystemBus::open(&bus.device, clock)?;
        Ok(Box::new(move || opened) as OpenBus<SystemBus>)
    };
    config.buses.iter().map(open).collect()
}

pub(super) fn actuator(config: &Config) -> Result<Box<dyn Actuator>, Error> {
    Ok(match config.actuator {
        ActuatorConfig::DryRun => Box::new(DryRun),
        ActuatorConfig::Udp { address, acknowledged } => Box::new(UdpActuator::new(address, acknowledged)?),
        ActuatorConfig::Mqtt { acknowledged } => {
            Box::new(MqttActuator::new(&config.name, broker(config)?, acknowledged)?)
        }
    })
}

pub(super) fn poses(config: &Config) -> Result<PoseReceiver, Error> {
    Ok(match config.pose.source {
        PoseSource::Udp { listen, from } => {
            if from.is_none() && !listen.ip().is_loopback() {
                return Err(format!(
                    "every computer can send poses to {listen}; name the one of the localisation, such as \
                     `pose: {{udp: {{listen: \"{listen}\", from: 192.168.1.20}}}}`"
                )
                .into());
            }
            let mut poses = UdpPoses::new(listen, from, POSE_WAIT)?;
            Box::new(move || poses.receive())
        }
        PoseSource::Mqtt {} => {
            let mut poses = MqttPoses::new(&config.name, broker(config)?)?;
            Box::new(move || poses.receive(POSE_WAIT))
        }
    })
}

pub(super) fn broker(config: &Config) -> Result<&MqttConfig, Error> {
    Ok(config.mqtt.as_ref().ok_or("the configuration has no MQTT broker; add `mqtt: {host: ...}`")?)
}

/// The receiver of records that publishes them, if there is a broker. `now_ns` is the time since the start of the program.
pub(super) fn telemetry(
    config: &Config,
    source: Source<'_>,
    now_ns: u64,
) -> Result<Option<Box<dyn RecordSink>>, Error> {
    let Some(mqtt) = &config.mqtt else { return Ok(None) };
    let publisher = Publisher::start(&source.name(&config.name), mqtt, print_error)?;
    Ok(Some(Box::new(TelemetrySink::new(config, source, publisher, now_ns))))
}
