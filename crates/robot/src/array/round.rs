//! A round: one reading of every board on a bus.

use crate::config::MAX_BOARDS;
use crate::fault::FaultKind;
use crate::sensor::RawRead;

/// The readings of all boards on a bus in one sample period.
#[derive(Debug, Clone, Copy)]
pub struct Round {
    /// Index of the bus.
    pub bus: u8,
    /// Number of the sample period since the start.
    pub slot: u64,
    /// Start of the round (ns).
    pub started_ns: u64,
    /// End of the round (ns).
    pub ended_ns: u64,
    /// Number of boards.
    pub count: u8,
    /// The readings in the order of the boards.
    pub readings: [BoardReading; MAX_BOARDS],
}

/// The reading of a board.
#[derive(Debug, Clone, Copy)]
pub struct BoardReading {
    /// The result.
    pub state: ReadingState,
    /// The bytes on the bus.
    pub raw: RawRead,
}

impl BoardReading {
    /// A reading without bytes.
    #[must_use]
    pub fn without_bytes(state: ReadingState) -> Self {
        Self { state, raw: RawRead::from_bytes(&[]) }
    }
}

/// The result of reading a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadingState {
    /// A new value, in counts.
    Fresh(i32),
    /// The field is at the end of the sensor's range, or has wrapped beyond it.
    Saturated,
    /// The board has no new value since the last round.
    Stale,
    /// The status byte is impossible.
    Garbled,
    /// The board does not answer.
    Silent,
    /// The board has lost its settings, and its bring-up has not succeeded yet.
    Lost,
}

impl ReadingState {
    /// The value in counts, if it is new and valid.
    #[must_use]
    pub fn counts(self) -> Option<i32> {
        if let Self::Fresh(counts) = self { Some(counts) } else { None }
    }

    /// The fault that the reading shows, if it shows one.
    #[must_use]
    pub fn fault(self) -> Option<FaultKind> {
        match self {
            Self::Fresh(_) => None,
            Self::Saturated => Some(FaultKind::Saturated),
            Self::Stale => Some(FaultKind::SensorStale),
            Self::Garbled => Some(FaultKind::InvalidReading),
            Self::Silent | Self::Lost => Some(FaultKind::SensorLost),
        }
    }

    /// True if one such reading is a fault. Others are faults if they last, because single ones are normal: a sensor
    /// that is slower than the loop is sometimes stale, and lines are disturbed.
    #[must_use]
    pub fn is_fault_at_once(self) -> bool {
        matches!(self, Self::Saturated | Self::Lost)
    }
}
