//! Poses over MQTT.

use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

use super::mqtt_link::{MqttLink, PACKET_BYTES};
use super::pose_packet::PosePacket;
use super::received_pose::ReceivedPose;
use crate::config::MqttConfig;
use crate::mqtt::StartError;
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
    /// [`StartError`] if the connection cannot begin.
    pub fn new(robot: &str, config: &MqttConfig) -> Result<Self, StartError> {
        let (sender, poses) = sync_channel(POSES);
        let receive = move |bytes: &[u8]| {
            if let Ok(packet) = PosePacket::from_bytes(bytes) {
                // A receiver that is late gets later ones.
                let _ = sender.try_send(packet);
            }
        };
        let subscription = Some(Topic::Pose.of(robot));
        let link = MqttLink::start(robot, "pose", config, PACKET_BYTES, subscription, || None, receive)?;
        Ok(Self { poses, _link: link })
    }

    /// Waits for a pose, for at most this time. Other messages are ignored.
    pub fn receive(&mut self, wait: Duration) -> Option<ReceivedPose> {
        self.poses.recv_timeout(wait).ok().map(ReceivedPose::Packet)
    }
}
