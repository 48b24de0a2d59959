//! Links to the outside: commands to an actuator, poses from a localisation.

mod actuator;
mod command_packet;
mod dry_run;
mod pose_packet;
mod udp;
mod wire;

pub use actuator::{Actuator, LinkError, StampedCommand};
pub use command_packet::{CommandPacket, PacketError};
pub use dry_run::DryRun;
pub use pose_packet::PosePacket;
pub use udp::{UdpActuator, UdpPoses};
