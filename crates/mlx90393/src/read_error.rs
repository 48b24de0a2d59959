//! Errors of a read.

use crate::raw_read::RawRead;
use crate::status::Status;
use core::convert::Infallible;
use thiserror::Error;

/// An error of [`Sensor::read`](crate::Sensor::read) or [`decode`](crate::decode).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum ReadError<E> {
    /// The bus reports an error.
    #[error("the bus reports {0:?}. Check the wiring, the supply and the address")]
    Bus(E),
    /// No conversion has ended since the last read (`ERROR` in burst mode).
    #[error("no new data, status {status}. Use the last value, and read more slowly if this repeats")]
    Stale {
        /// The status.
        status: Status,
        /// The received bytes.
        raw: RawRead,
    },
    /// The sensor is not in burst mode, for instance because it was reset and its status was read before.
    #[error("the sensor is not in burst mode, status {status}. Start it again")]
    ModeLost {
        /// The status.
        status: Status,
        /// The received bytes.
        raw: RawRead,
    },
    /// The sensor was reset since the last status, so its settings are lost.
    #[error("the sensor was reset, status {status}. Start it again and check its supply")]
    Reset {
        /// The status.
        status: Status,
        /// The received bytes.
        raw: RawRead,
    },
    /// The status is impossible, or the number of bytes is wrong.
    #[error("the answer is garbled, status {status}. Discard it, and check the wiring if this repeats")]
    Garbled {
        /// The status.
        status: Status,
        /// The received bytes.
        raw: RawRead,
    },
}

impl<E> ReadError<E> {
    /// The received bytes, if there are any.
    #[must_use]
    pub fn raw(&self) -> Option<&RawRead> {
        match self {
            Self::Bus(_) => None,
            Self::Stale { raw, .. }
            | Self::ModeLost { raw, .. }
            | Self::Reset { raw, .. }
            | Self::Garbled { raw, .. } => Some(raw),
        }
    }
}

impl ReadError<Infallible> {
    /// The same error for another type of bus error.
    pub(crate) fn on_bus<E>(self) -> ReadError<E> {
        match self {
            Self::Bus(never) => match never {},
            Self::Stale { status, raw } => ReadError::Stale { status, raw },
            Self::ModeLost { status, raw } => ReadError::ModeLost { status, raw },
            Self::Reset { status, raw } => ReadError::Reset { status, raw },
            Self::Garbled { status, raw } => ReadError::Garbled { status, raw },
        }
    }
}
