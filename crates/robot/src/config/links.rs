//! The sections `actuator`, `pose`, `mqtt` and `record`.

use std::net::SocketAddr;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::quantity;

/// The receiver of the commands.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ActuatorConfig {
    /// No command leaves the program.
    #[default]
    DryRun,
    /// Packets to this address.
    Udp {
        /// Address of the actuator.
        address: SocketAddr,
        /// True if the actuator acknowledges every packet.
        #[serde(default = "yes")]
        acknowledged: bool,
    },
    /// Packets as messages with the topic `vibrissa/NAME/command`.
    Mqtt {
        /// True if the actuator acknowledges every packet, with the topic `vibrissa/NAME/acknowledged`.
        #[serde(default = "yes")]
        acknowledged: bool,
    },
}

fn yes() -> bool {
    true
}

/// The source of the platform's pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseConfig {
    /// The sender.
    #[serde(flatten)]
    pub source: PoseSource,
    /// Age of a pose when it arrives (s).
    #[serde(default, with = "quantity::time")]
    pub latency: f64,
}

/// The sender of poses.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PoseSource {
    /// Packets to this address of the robot.
    Udp {
        /// Address on which the program listens.
        listen: SocketAddr,
    },
    /// Packets as messages with the topic `vibrissa/NAME/pose`.
    Mqtt {},
}

/// An MQTT broker.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MqttConfig {
    /// Name or address of the broker.
    pub host: String,
    /// Port of the broker.
    #[serde(default = "mqtt_port")]
    pub port: u16,
    /// Messages that wait while the broker is away, at least one. The oldest are dropped.
    #[serde(default = "mqtt_buffer")]
    pub buffer: usize,
}

fn mqtt_port() -> u16 {
    1883
}

fn mqtt_buffer() -> usize {
    20_000
}

/// The recording on the device.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordConfig {
    /// Directory of the recordings.
    pub directory: PathBuf,
    /// Largest total size of the recordings, in megabytes. The oldest ones are deleted.
    #[serde(default = "record_limit")]
    pub limit_mb: u64,
}

fn record_limit() -> u64 {
    1000
}
