//! The packet of a pose.

use vibrissa_runtime::geometry::{Point2, Pose};

use super::command_packet::PacketError;

/// A pose as the localisation sends it.
///
/// | bytes | content, little endian |
/// |---|---|
/// | 4 | `VBP1` |
/// | 8 | sequence number. A packet with a lower one than the last is ignored |
/// | 8, 8 | position of the centre of mass in the world frame, x and y (m, IEEE 754) |
/// | 8 | heading (rad, IEEE 754), not wrapped |
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
        let parts = [
            &MAGIC[..],
            &self.sequence.to_le_bytes(),
            &position.x.to_le_bytes(),
            &position.y.to_le_bytes(),
            &heading.to_le_bytes(),
        ];
        let mut bytes = [0; Self::LENGTH];
        for (byte, value) in bytes.iter_mut().zip(parts.into_iter().flatten()) {
            *byte = *value;
        }
        bytes
    }

    /// Reads a packet. Its numbers may be NaN: a localisation says so that it has no pose.
    ///
    /// # Errors
    /// [`PacketError`] if the bytes are no such packet.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PacketError> {
        let rest = bytes.strip_prefix(&MAGIC).filter(|_| bytes.len() == Self::LENGTH).ok_or(PacketError)?;
        let word = |index: usize| rest.get(8 * index..).and_then(|rest| rest.first_chunk::<8>()).ok_or(PacketError);
        let number = |index: usize| word(index).map(|word| f64::from_le_bytes(*word));
        let position = Point2::new(number(1)?, number(2)?);
        Ok(Self { sequence: u64::from_le_bytes(*word(0)?), pose: Pose { position, heading: number(3)? } })
    }
}
