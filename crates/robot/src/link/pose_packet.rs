//! The packet of a pose.

use vibrissa_runtime::geometry::{Point2, Pose};

use super::command_packet::PacketError;
use super::wire::{Content, joined};

/// A pose as the localisation sends it.
///
/// | bytes | content, little endian |
/// |---|---|
/// | 4 | `VBP1` |
/// | 8 | sequence number, which grows. A packet with a lower one than the last is ignored, until a new sequence begins |
/// | 8, 8 | position of the centre of mass in the world frame, x and y (m, IEEE 754) |
/// | 8 | heading (rad, IEEE 754), wrapped or not |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosePacket {
    /// Sequence number.
    pub sequence: u64,
    /// The pose.
    pub pose: Pose,
}

const MAGIC: [u8; 4] = *b"VBP1";

impl PosePacket {
    /// Length of a packet in bytes.
    pub const LENGTH: usize = 36;

    /// The bytes of the packet.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::LENGTH] {
        let Pose { position, heading } = self.pose;
        joined(&[
            &MAGIC,
            &self.sequence.to_le_bytes(),
            &position.x.to_le_bytes(),
            &position.y.to_le_bytes(),
            &heading.to_le_bytes(),
        ])
    }

    /// Reads a packet. Its numbers may be NaN: a localisation says so that it has no pose.
    ///
    /// # Errors
    /// [`PacketError`] if the bytes are no such packet.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PacketError> {
        let content = Content::of(bytes, MAGIC, Self::LENGTH)?;
        let position = Point2::new(content.number(1)?, content.number(2)?);
        Ok(Self { sequence: content.integer(0)?, pose: Pose { position, heading: content.number(3)? } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_packet_is_read_as_it_was_written(sequence: u64, x in -1e3..1e3, y in -1e3..1e3, heading in -9.0..9.0) {
            let packet = PosePacket { sequence, pose: Pose { position: Point2::new(x, y), heading } };
            prop_assert_eq!(PosePacket::from_bytes(&packet.to_bytes()), Ok(packet));
        }

        #[test]
        fn other_bytes_are_refused(bytes: Vec<u8>) {
            prop_assert_eq!(PosePacket::from_bytes(&bytes), Err(PacketError));
        }
    }
}
