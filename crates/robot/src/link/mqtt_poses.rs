//! Poses over MQTT.

use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

use super::mqtt_link::{MqttLink, PACKET_BYTES};
use super::pose_packet::{PosePacket, PoseReader};
use crate::config::MqttConfig;
use crate::telemetry::Topic;

/// Poses that wait for the receiver.
const POSES: usize = 64;

/// Poses that arrive as [`PosePacket`]s from an MQTT broker.
#[derive(Debug)]
pub struct MqttPoses {
    poses: Receiver<PosePacket>,
    /// It ends when the poses are dropped.
    _link: MqttLink,
}

impl MqttPoses {
    /// The poses of the robot with this name.
    ///
    /// # Errors
    /// The system's error if it has no more files or threads.
    pub fn new(robot: &str, config: &MqttConfig) -> std::io::Result<Self> {
        let (sender, poses) = sync_channel(POSES);
        let mut reader = PoseReader::default();
        let receive = move |bytes: &[u8]| {
            if let Some(packet) = reader.read(bytes) {
                // A receiver that is late gets later ones.
                let _ = sender.try_send(packet);
            }
        };
        let subscription = Some(Topic::Pose.of(robot));
        let link = MqttLink::start(robot, "pose", config, PACKET_BYTES, subscription, || None, receive)?;
        Ok(Self { poses, _link: link })
    }

    /// Waits for a pose, for at most this time. Other messages, and poses out of order, are ignored.
    pub fn receive(&mut self, wait: Duration) -> Option<PosePacket> {
        self.poses.recv_timeout(wait).ok()
    }
}
