//! Commands and poses over UDP.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};

use super::acknowledgements::Acknowledgements;
use super::actuator::{Actuator, LinkError};
use super::command_packet::CommandPacket;
use super::received_pose::ReceivedPose;
use crate::config::Sender;

/// Largest number of packets that are read at once, so that a flood cannot hold the caller.
const MOST_PACKETS: usize = 64;

/// An actuator that receives [`CommandPacket`]s.
#[derive(Debug)]
pub struct UdpActuator {
    socket: UdpSocket,
    acknowledgements: Option<Acknowledgements>,
}

impl UdpActuator {
    /// An actuator at this address. It is `acknowledged` if it answers every packet.
    ///
    /// # Errors
    /// The error of the socket.
    pub fn new(address: SocketAddr, is_acknowledged: bool) -> std::io::Result<Self> {
        let any: SocketAddr = if address.is_ipv4() { ([0; 4], 0).into() } else { ([0_u16; 8], 0).into() };
        let socket = UdpSocket::bind(any)?;
        socket.connect(address)?;
        socket.set_nonblocking(true)?;
        Ok(Self { socket, acknowledgements: is_acknowledged.then(Acknowledgements::default) })
    }
}

impl Actuator for UdpActuator {
    fn send(&mut self, packet: &CommandPacket) -> Result<(), LinkError> {
        if let Some(acknowledgements) = &mut self.acknowledgements {
            acknowledgements.sent(packet.sequence, packet.time_ns);
        }
        match self.socket.send(&packet.to_bytes()) {
            Ok(_) => Ok(()),
            // The answer of a host without a receiver to an earlier packet. The missing acknowledgement tells it.
            Err(error) if error.kind() == ErrorKind::ConnectionRefused => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn acknowledged_ns(&mut self, now_ns: u64) -> Option<u64> {
        let acknowledgements = self.acknowledgements.as_mut()?;
        let mut bytes = [0; 32];
        for _ in 0..MOST_PACKETS {
            let Ok(length) = self.socket.recv(&mut bytes) else { break };
            if let Some(Ok(sequence)) = bytes.get(..length).map(CommandPacket::acknowledged) {
                acknowledgements.received(sequence);
            }
        }
        Some(acknowledgements.last_ns(now_ns))
    }
}

/// Poses that arrive as [`PosePacket`](super::PosePacket)s.
#[derive(Debug)]
pub struct UdpPoses {
    socket: UdpSocket,
    from: Option<Sender>,
}

impl UdpPoses {
    /// Listens on an address for the packets of this sender, or of every one. [`receive`](Self::receive) waits for at most `wait`.
    ///
    /// # Errors
    /// The error of the socket.
    pub fn new(listen: SocketAddr, from: Option<Sender>, wait: std::time::Duration) -> std::io::Result<Self> {
        let socket = UdpSocket::bind(listen)?;
        socket.set_read_timeout(Some(wait))?;
        Ok(Self { socket, from })
    }

    /// The address on which it listens.
    ///
    /// # Errors
    /// The error of the socket.
    pub fn address(&self) -> std::io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    /// Waits for a pose. Other packets of the sender are ignored.
    pub fn receive(&mut self) -> Option<ReceivedPose> {
        let mut bytes = [0; 64];
        let (length, sender) = self.socket.recv_from(&mut bytes).ok()?;
        ReceivedPose::read(bytes.get(..length)?, sender, self.from)
    }
}
