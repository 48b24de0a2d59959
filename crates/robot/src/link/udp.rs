//! Commands and poses over UDP.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};

use super::actuator::{Actuator, LinkError};
use super::command_packet::CommandPacket;
use super::pose_packet::PosePacket;

/// Largest number of packets that are read at once, so that a flood cannot hold the caller.
const MOST_PACKETS: usize = 64;

/// An actuator that receives [`CommandPacket`]s.
#[derive(Debug)]
pub struct UdpActuator {
    socket: UdpSocket,
    is_acknowledged: bool,
    last_sent: u64,
    last_acknowledged_ns: Option<u64>,
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
        Ok(Self { socket, is_acknowledged, last_sent: 0, last_acknowledged_ns: None })
    }
}

impl Actuator for UdpActuator {
    fn send(&mut self, packet: &CommandPacket) -> Result<(), LinkError> {
        self.last_sent = packet.sequence;
        match self.socket.send(&packet.to_bytes()) {
            Ok(_) => Ok(()),
            // The answer of a host without a receiver to an earlier packet. The missing acknowledgement tells it.
            Err(error) if error.kind() == ErrorKind::ConnectionRefused => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn acknowledged_ns(&mut self, now_ns: u64) -> Option<u64> {
        if !self.is_acknowledged {
            return None;
        }
        let mut bytes = [0; 32];
        for _ in 0..MOST_PACKETS {
            let Ok(length) = self.socket.recv(&mut bytes) else { break };
            let sequence = bytes.get(..length).and_then(|bytes| CommandPacket::acknowledged(bytes).ok());
            if sequence.is_some_and(|sequence| sequence <= self.last_sent) {
                self.last_acknowledged_ns = Some(now_ns);
            }
        }
        Some(*self.last_acknowledged_ns.get_or_insert(now_ns))
    }
}

/// Poses that arrive as [`PosePacket`]s.
#[derive(Debug)]
pub struct UdpPoses {
    socket: UdpSocket,
    last_sequence: Option<u64>,
}

impl UdpPoses {
    /// Listens on an address. [`receive`](Self::receive) waits for at most `wait`.
    ///
    /// # Errors
    /// The error of the socket.
    pub fn new(listen: SocketAddr, wait: std::time::Duration) -> std::io::Result<Self> {
        let socket = UdpSocket::bind(listen)?;
        socket.set_read_timeout(Some(wait))?;
        Ok(Self { socket, last_sequence: None })
    }

    /// The address on which it listens.
    ///
    /// # Errors
    /// The error of the socket.
    pub fn address(&self) -> std::io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    /// Waits for a pose. Other packets, and packets out of order, are ignored.
    pub fn receive(&mut self) -> Option<PosePacket> {
        let mut bytes = [0; 64];
        let length = self.socket.recv(&mut bytes).ok()?;
        let packet = PosePacket::from_bytes(bytes.get(..length)?).ok()?;
        if self.last_sequence.is_some_and(|last| packet.sequence <= last) {
            return None;
        }
        self.last_sequence = Some(packet.sequence);
        Some(packet)
    }
}
