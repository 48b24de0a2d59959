//! Errors of an emulated bus.

use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource};
use thiserror::Error;

/// An error of an emulated bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum EmulatedBusError {
    /// No sensor acknowledges the address.
    #[error("no sensor acknowledges address {address:#04x}. Add one, or clear its fault")]
    NoAcknowledge {
        /// The address.
        address: u8,
    },
    /// The bus is stuck, so the transaction timed out.
    #[error("the bus is stuck for {timeout_ns} ns. Clear its fault")]
    Timeout {
        /// Duration of the transaction (ns).
        timeout_ns: u64,
    },
    /// The arbitration was lost.
    #[error("the arbitration was lost. Clear the fault of the bus, or repeat the transaction")]
    ArbitrationLost,
    /// A start or stop appeared at a wrong place.
    #[error("a start or stop is misplaced. Clear the fault of the bus, or repeat the transaction")]
    Misplaced,
}

impl embedded_hal::i2c::Error for EmulatedBusError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::NoAcknowledge { .. } => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address),
            Self::Timeout { .. } => ErrorKind::Other,
            Self::ArbitrationLost => ErrorKind::ArbitrationLoss,
            Self::Misplaced => ErrorKind::Bus,
        }
    }
}
