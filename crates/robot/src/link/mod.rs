//! Links to the outside: commands to an actuator, poses from a localisation.

mod acknowledgements;
mod actuator;
mod command_packet;
mod dry_run;
#[cfg(feature = "mqtt")]
mod mqtt_actuator;
#[cfg(feature = "mqtt")]
mod mqtt_link;
#[cfg(feature = "mqtt")]
mod mqtt_poses;
mod pose_packet;
mod udp;
mod wire;

pub use actuator::{Actuator, LinkError, StampedCommand};
pub use command_packet::{CommandPacket, PacketError};
pub use dry_run::DryRun;
#[cfg(feature = "mqtt")]
pub use mqtt_actuator::MqttActuator;
#[cfg(feature = "mqtt")]
pub(crate) use mqtt_link::{MqttLink, PACKET_BYTES};
#[cfg(feature = "mqtt")]
pub use mqtt_poses::MqttPoses;
pub use pose_packet::PosePacket;
pub use udp::{UdpActuator, UdpPoses};
