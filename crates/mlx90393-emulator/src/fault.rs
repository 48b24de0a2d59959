//! Faults.

use crate::bus_error::EmulatedBusError;

/// A fault of a sensor. Except for [`SensorFault::BrownOut`] and [`SensorFault::ModeLost`], it lasts until it is cleared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensorFault {
    /// The oscillator stands still, so there is no new data. Conversions continue when it is cleared.
    ClockStopped,
    /// The supply drops once: the registers return to the stored values, and the next status reports the reset.
    BrownOut,
    /// Burst mode ends once, without a reset.
    ModeLost,
    /// The sensor does not acknowledge its address.
    NoAcknowledge {
        /// Number of transactions, or `None` until it is cleared.
        transactions: Option<u32>,
    },
    /// Bits of the next answers are inverted.
    BitFlip {
        /// Index of the byte in an answer. The status has index 0.
        byte: usize,
        /// The inverted bits.
        mask: u8,
        /// Number of answers.
        answers: u32,
    },
    /// Measurements repeat the data of the last read, with a fresh status.
    Frozen,
    /// The outputs of all axes are held at an end of their range.
    Saturated {
        /// True for fields below zero.
        negative: bool,
    },
    /// The offset of each axis jumps.
    OffsetJump {
        /// Size of the jump (µT).
        microtesla: [f64; 3],
    },
    /// Each status reports a corrected bit of the memory (`SED`).
    CorrectedBit,
}

/// A fault of a bus. It lasts until it is cleared, or for its number of transactions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BusFault {
    /// A line is held low. Each transaction blocks for this time and then fails. Linux waits 1.024 s.
    Stuck {
        /// The time (ns).
        timeout_ns: u64,
    },
    /// The arbitration is lost at the address.
    ArbitrationLost {
        /// Number of transactions, or `None` until it is cleared.
        transactions: Option<u32>,
    },
    /// A start or stop appears at a wrong place.
    Misplaced {
        /// Number of transactions, or `None` until it is cleared.
        transactions: Option<u32>,
    },
}

impl BusFault {
    /// A stuck bus with the timeout of Linux.
    pub const STUCK: Self = Self::Stuck { timeout_ns: 1_024_000_000 };

    /// The error of the next transaction, or `None` if the fault has ended.
    pub(crate) fn next(&mut self) -> Option<EmulatedBusError> {
        match self {
            Self::Stuck { timeout_ns } => Some(EmulatedBusError::Timeout { timeout_ns: *timeout_ns }),
            Self::ArbitrationLost { transactions } => {
                count_down(transactions).then_some(EmulatedBusError::ArbitrationLost)
            }
            Self::Misplaced { transactions } => count_down(transactions).then_some(EmulatedBusError::Misplaced),
        }
    }
}

/// Counts a transaction with a fault. The result is false if the fault has ended.
pub(crate) fn count_down(transactions: &mut Option<u32>) -> bool {
    match transactions {
        None => true,
        Some(0) => false,
        Some(left) => {
            *left -= 1;
            true
        }
    }
}
