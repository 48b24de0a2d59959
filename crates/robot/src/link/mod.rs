//! Links to the outside: commands to an actuator, poses from a localisation.

mod acknowledgements;
mod actuator;
mod command_gate;
mod command_packet;
mod dry_run;
#[cfg(feature = "mqtt")]
mod mqtt_actuator;
#[cfg(feature = "mqtt")]
mod mqtt_link;
#[cfg(feature = "mqtt")]
mod mqtt_poses;
mod order;
mod pose_gate;
mod pose_packet;
mod received_pose;
mod sender_clock;
mod udp;
mod wire;

#[cfg(feature = "emulation")]
pub(crate) use acknowledgements::Acknowledgements;
pub use actuator::{Actuator, LinkError, StampedCommand};
pub use command_gate::{CommandGate, CommandVerdict};
pub use command_packet::{CommandPacket, PacketError};
pub use dry_run::DryRun;
#[cfg(feature = "mqtt")]
pub use mqtt_actuator::MqttActuator;
#[cfg(feature = "mqtt")]
pub(crate) use mqtt_link::{MqttLink, PACKET_BYTES};
#[cfg(feature = "mqtt")]
pub use mqtt_poses::MqttPoses;
#[cfg(all(feature = "mqtt", feature = "recording"))]
pub(crate) use order::{Order, Place};
pub use pose_gate::PoseGate;
pub use pose_packet::PosePacket;
pub use received_pose::ReceivedPose;
#[cfg(all(feature = "mqtt", feature = "recording"))]
pub(crate) use sender_clock::SenderClock;
pub use udp::{UdpActuator, UdpPoses};
