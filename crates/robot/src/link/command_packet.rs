//! The packet of a command, and its acknowledgement.

use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::signal::Command;

use super::wire::{Content, joined};

/// A command as it leaves the robot's program.
///
/// | bytes | content, little endian |
/// |---|---|
/// | 4 | `VBC1` |
/// | 8 | sequence number, from 1 |
/// | 8 | time since the start of the program (ns) |
/// | 8, 8 | velocity of the centre of mass in the world frame, x and y (m/s, IEEE 754) |
/// | 8 | yaw rate (rad/s, IEEE 754) |
/// | 1 | 1 if this is a stop, otherwise 0 |
/// | 4 | time after which the receiver must stop if no further packet arrives (ms) |
///
/// A receiver acknowledges with `VBA1` and the sequence number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandPacket {
    /// Sequence number, from 1.
    pub sequence: u64,
    /// Time since the start of the program (ns).
    pub time_ns: u64,
    /// The command.
    pub command: Command,
    /// True if the supervisor stops the robot.
    pub is_stop: bool,
}

/// Bytes that are no packet of this kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("these bytes are not a packet of Vibrissa; check the sender's version and the port")]
pub struct PacketError;

const MAGIC: [u8; 4] = *b"VBC1";
const ACKNOWLEDGEMENT: [u8; 4] = *b"VBA1";

impl CommandPacket {
    /// Length of a packet in bytes.
    pub const LENGTH: usize = 49;
    /// Time (ms) for which a command is valid.
    pub const VALID_MS: u32 = 100;

    /// The bytes of the packet.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::LENGTH] {
        let Command { velocity_world, yaw_rate } = self.command;
        joined(&[
            &MAGIC,
            &self.sequence.to_le_bytes(),
            &self.time_ns.to_le_bytes(),
            &velocity_world.x.to_le_bytes(),
            &velocity_world.y.to_le_bytes(),
            &yaw_rate.to_le_bytes(),
            &[u8::from(self.is_stop)],
            &Self::VALID_MS.to_le_bytes(),
        ])
    }

    /// Reads a packet.
    ///
    /// # Errors
    /// [`PacketError`] if the bytes are no such packet, or if a number in it is not finite.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PacketError> {
        let content = Content::of(bytes, MAGIC, Self::LENGTH)?;
        let velocity_world = Vector2::new(content.number(2)?, content.number(3)?);
        let command = Command { velocity_world, yaw_rate: content.number(4)? };
        let is_stop = match content.byte(40) {
            Some(0) => false,
            Some(1) => true,
            _ => return Err(PacketError),
        };
        if !command.is_finite() {
            return Err(PacketError);
        }
        Ok(Self { sequence: content.integer(0)?, time_ns: content.integer(1)?, command, is_stop })
    }

    /// The acknowledgement of this packet.
    #[must_use]
    pub fn acknowledgement(&self) -> [u8; 12] {
        Self::acknowledgement_of(self.sequence)
    }

    /// The acknowledgement of the packet with this sequence number.
    #[must_use]
    pub fn acknowledgement_of(sequence: u64) -> [u8; 12] {
        joined(&[&ACKNOWLEDGEMENT, &sequence.to_le_bytes()])
    }

    /// The sequence number of an acknowledgement.
    ///
    /// # Errors
    /// [`PacketError`] if the bytes are no acknowledgement.
    pub fn acknowledged(bytes: &[u8]) -> Result<u64, PacketError> {
        Content::of(bytes, ACKNOWLEDGEMENT, 12)?.integer(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_packet_is_read_as_it_was_written(
            sequence: u64, time_ns: u64, x in -1e3..1e3, y in -1e3..1e3, yaw_rate in -9.0..9.0, is_stop: bool,
        ) {
            let command = Command { velocity_world: Vector2::new(x, y), yaw_rate };
            let packet = CommandPacket { sequence, time_ns, command, is_stop };
            prop_assert_eq!(CommandPacket::from_bytes(&packet.to_bytes()), Ok(packet));
            prop_assert_eq!(CommandPacket::acknowledged(&packet.acknowledgement()), Ok(sequence));
        }

        #[test]
        fn other_bytes_are_refused(bytes: Vec<u8>) {
            prop_assert_eq!(CommandPacket::from_bytes(&bytes), Err(PacketError));
            prop_assert_eq!(CommandPacket::acknowledged(&bytes), Err(PacketError));
        }
    }
}
