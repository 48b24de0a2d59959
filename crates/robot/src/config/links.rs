//! The sections `actuator`, `pose`, `mqtt` and `record`.

use std::net::SocketAddr;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::quantity;
use super::sender::Sender;

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
    /// Largest difference between two positions of a platform at rest (m).
    #[serde(default = "pose_noise", with = "quantity::length")]
    pub noise: f64,
    /// Largest difference between two of its headings (rad).
    #[serde(default = "heading_noise", with = "quantity::angle")]
    pub heading_noise: f64,
}

impl PoseConfig {
    /// Poses of this source, without latency and with the default noise.
    #[must_use]
    pub fn new(source: PoseSource) -> Self {
        Self { source, latency: 0.0, noise: pose_noise(), heading_noise: heading_noise() }
    }
}

fn pose_noise() -> f64 {
    0.02
}

fn heading_noise() -> f64 {
    5_f64.to_radians()
}

/// The sender of poses.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PoseSource {
    /// Packets to this address of the robot.
    Udp {
        /// Address on which the program listens.
        listen: SocketAddr,
        /// The sender whose packets are taken. Without it, every packet is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from: Option<Sender>,
    },
    /// Packets as messages with the topic `vibrissa/NAME/pose`.
    Mqtt {},
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
