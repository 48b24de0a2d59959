//! What a source of poses receives.

use std::net::SocketAddr;

use super::pose_packet::PosePacket;
use crate::config::Sender;

/// What a source of poses receives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReceivedPose {
    /// A packet of the localisation.
    Packet(PosePacket),
    /// A packet of another sender than the configuration names. Its content is not read.
    Foreign,
}

impl ReceivedPose {
    /// Reads what this sender has sent, if packets are taken `from` it. `None` is no packet of a pose.
    #[must_use]
    pub fn read(bytes: &[u8], sender: SocketAddr, from: Option<Sender>) -> Option<Self> {
        if from.is_some_and(|from| !from.is(sender)) {
            return Some(Self::Foreign);
        }
        PosePacket::from_bytes(bytes).ok().map(Self::Packet)
    }
}
