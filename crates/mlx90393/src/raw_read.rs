//! Received bytes.

use crate::status::Status;

/// The bytes of one read: the status, then two bytes per quantity in the order T, X, Y, Z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RawRead {
    /// The bytes. Those after `length` are 0.
    pub bytes: [u8; 9],
    /// Number of received bytes, at most 9.
    pub length: u8,
}

impl RawRead {
    /// Copies bytes. Those after the ninth are omitted.
    #[must_use]
    pub fn from_bytes(received: &[u8]) -> Self {
        let mut raw = Self { bytes: [0; 9], length: 0 };
        for (to, from) in raw.bytes.iter_mut().zip(received) {
            *to = *from;
            raw.length += 1;
        }
        raw
    }

    /// The received bytes.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.length)).unwrap_or(&self.bytes)
    }

    /// The status, which is the first byte. It is 0 if nothing was received.
    #[must_use]
    pub const fn status(&self) -> Status {
        let [status, ..] = self.bytes;
        Status::from_byte(status)
    }
}
