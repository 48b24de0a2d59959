//! Replay of transcripts.

use crate::bus_error::EmulatedBusError;
use crate::transcript::{RecordedOperation, RecordedTransaction, Transcript};
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, Operation};
use std::collections::VecDeque;
use thiserror::Error;

/// A bus that answers from a transcript. Each transaction must be the next recorded one.
#[derive(Debug, Clone)]
pub struct ReplayBus {
    remaining: VecDeque<RecordedTransaction>,
    replayed: usize,
}

/// An error of a [`ReplayBus`].
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ReplayError {
    /// The transaction is not the recorded one. The recorded one remains the next.
    #[error(
        "transaction {index} of the transcript is `{expected}`, not `{actual}`. Replay with the settings of the recording"
    )]
    Mismatch {
        /// Index in the transcript.
        index: usize,
        /// The recorded transaction.
        expected: String,
        /// The transaction of the program.
        actual: String,
    },
    /// The transcript has ended.
    #[error("the transcript ends after {index} transactions, before `{actual}`. Replay only what was recorded")]
    Ended {
        /// Number of recorded transactions.
        index: usize,
        /// The transaction of the program.
        actual: String,
    },
    /// The transaction failed when it was recorded.
    #[error("as recorded: {0}")]
    Recorded(EmulatedBusError),
}

impl embedded_hal::i2c::Error for ReplayError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Recorded(error) => error.kind(),
            Self::Mismatch { .. } | Self::Ended { .. } => ErrorKind::Other,
        }
    }
}

impl ReplayBus {
    /// Creates a bus that answers from a transcript.
    #[must_use]
    pub fn new(transcript: Transcript) -> Self {
        Self { remaining: transcript.transactions.into(), replayed: 0 }
    }

    /// Number of transactions that were not replayed yet.
    #[must_use]
    pub fn remaining(&self) -> usize {
        self.remaining.len()
    }
}

impl ErrorType for ReplayBus {
    type Error = ReplayError;
}

impl I2c for ReplayBus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ReplayError> {
        let index = self.replayed;
        let actual = || RecordedTransaction::new(0, address, operations, None).to_string();
        let Some(recorded) = self.remaining.front() else {
            return Err(ReplayError::Ended { index, actual: actual() });
        };
        // The text is exactly what the master sends.
        let (expected, actual) = (recorded.to_string(), actual());
        if expected != actual {
            return Err(ReplayError::Mismatch { index, expected, actual });
        }
        for (operation, recorded) in operations.iter_mut().zip(&recorded.operations) {
            if let (Operation::Read(buffer), RecordedOperation::Read(bytes)) = (operation, recorded) {
                buffer.copy_from_slice(bytes);
            }
        }
        let error = recorded.error;
        self.remaining.pop_front();
        self.replayed += 1;
        error.map_or(Ok(()), |error| Err(ReplayError::Recorded(error)))
    }
}
