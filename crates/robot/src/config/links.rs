//! The sections `actuator`, `pose`, `mqtt` and `record`.

use std::net::SocketAddr;
use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize};

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
#[serde(try_from = "PoseSection", into = "PoseSection")]
pub struct PoseConfig {
    /// The sender.
    pub source: PoseSource,
    /// Age of a pose when it arrives (s).
    pub latency: f64,
    /// Largest difference between two positions of a platform at rest (m).
    pub noise: f64,
    /// Largest difference between two of its headings (rad).
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
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PoseSource {
    /// Packets to this address of the robot.
    Udp {
        /// Address on which the program listens.
        listen: SocketAddr,
        /// The sender whose packets are taken. Without it, every packet is.
        from: Option<Sender>,
    },
    /// Packets as messages with the topic `vibrissa/NAME/pose`.
    Mqtt {},
}

/// The section as it is written. The keys of its sources are in one list with the others, so that each has its place in the text.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseSection {
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    udp: Option<UdpPoses>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    mqtt: Option<MqttPoses>,
    #[serde(default, with = "quantity::time")]
    latency: f64,
    #[serde(default = "pose_noise", with = "quantity::length")]
    noise: f64,
    #[serde(default = "heading_noise", with = "quantity::angle")]
    heading_noise: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct UdpPoses {
    listen: SocketAddr,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from: Option<Sender>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MqttPoses {}

/// Reads a key that is there. Without content it is not the same as a key that is missing.
fn present<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

/// A section without exactly one source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
enum PoseSectionError {
    #[error("has no source of poses; add `udp: {{listen: \"127.0.0.1:9751\"}}` or `mqtt: {{}}`")]
    None,
    #[error("has two sources of poses; keep either `udp` or `mqtt`")]
    Two,
}

impl TryFrom<PoseSection> for PoseConfig {
    type Error = PoseSectionError;

    fn try_from(section: PoseSection) -> Result<Self, PoseSectionError> {
        let PoseSection { udp, mqtt, latency, noise, heading_noise } = section;
        let source = match (udp, mqtt) {
            (Some(UdpPoses { listen, from }), None) => PoseSource::Udp { listen, from },
            (None, Some(MqttPoses {})) => PoseSource::Mqtt {},
            (None, None) => return Err(PoseSectionError::None),
            (Some(_), Some(_)) => return Err(PoseSectionError::Two),
        };
        Ok(Self { source, latency, noise, heading_noise })
    }
}

impl From<PoseConfig> for PoseSection {
    fn from(config: PoseConfig) -> Self {
        let PoseConfig { source, latency, noise, heading_noise } = config;
        let (udp, mqtt) = match source {
            PoseSource::Udp { listen, from } => (Some(UdpPoses { listen, from }), None),
            PoseSource::Mqtt {} => (None, Some(MqttPoses {})),
        };
        Self { udp, mqtt, latency, noise, heading_noise }
    }
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
