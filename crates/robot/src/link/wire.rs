//! The layout that all packets share: four letters, then 64-bit words in little endian, then single bytes.

use super::command_packet::PacketError;

/// The content of a packet after its letters.
pub(super) struct Content<'b>(&'b [u8]);

impl<'b> Content<'b> {
    /// The content of a packet of `length` bytes that begins with `magic`.
    pub(super) fn of(bytes: &'b [u8], magic: [u8; 4], length: usize) -> Result<Self, PacketError> {
        bytes.strip_prefix(&magic).filter(|_| bytes.len() == length).map(Self).ok_or(PacketError)
    }

    /// The word with this index as an integer.
    pub(super) fn integer(&self, index: usize) -> Result<u64, PacketError> {
        let word = self.0.get(8 * index..).and_then(|rest| rest.first_chunk()).ok_or(PacketError)?;
        Ok(u64::from_le_bytes(*word))
    }

    /// The word with this index as a number.
    pub(super) fn number(&self, index: usize) -> Result<f64, PacketError> {
        self.integer(index).map(f64::from_bits)
    }

    /// The byte with this index.
    pub(super) fn byte(&self, index: usize) -> Option<u8> {
        self.0.get(index).copied()
    }
}

/// Joins the parts of a packet. Further bytes are zero.
pub(super) fn joined<const LENGTH: usize>(parts: &[&[u8]]) -> [u8; LENGTH] {
    let mut bytes = [0; LENGTH];
    for (byte, value) in bytes.iter_mut().zip(parts.iter().copied().flatten()) {
        *byte = *value;
    }
    bytes
}
