//! Transcripts of transactions.

use crate::bus_error::EmulatedBusError;
use embedded_hal::i2c::Operation;
use std::fmt;

/// The transactions of a bus in their order.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Transcript {
    /// The transactions.
    pub transactions: Vec<RecordedTransaction>,
}

/// A transaction with its result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedTransaction {
    /// Time of the start (ns).
    pub time_ns: u64,
    /// The 7-bit address.
    pub address: u8,
    /// The operations with their bytes. After an error, the bytes of reads have no meaning.
    pub operations: Vec<RecordedOperation>,
    /// The error, or `None`.
    pub error: Option<EmulatedBusError>,
}

/// An operation of a transaction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RecordedOperation {
    /// Bytes that the sensor received.
    Write(Vec<u8>),
    /// Bytes that the sensor sent.
    Read(Vec<u8>),
}

impl RecordedTransaction {
    pub(crate) fn new(
        time_ns: u64,
        address: u8,
        operations: &[Operation<'_>],
        error: Option<EmulatedBusError>,
    ) -> Self {
        let operations = operations
            .iter()
            .map(|operation| match operation {
                Operation::Write(bytes) => RecordedOperation::Write(bytes.to_vec()),
                Operation::Read(buffer) => RecordedOperation::Read(buffer.to_vec()),
            })
            .collect();
        Self { time_ns, address, operations, error }
    }
}

impl fmt::Display for RecordedTransaction {
    /// Writes what the master sends: the address, the written bytes and the number of read bytes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "address {:#04x}", self.address)?;
        for operation in &self.operations {
            match operation {
                RecordedOperation::Write(bytes) => write!(f, ", write {bytes:02x?}")?,
                RecordedOperation::Read(bytes) => write!(f, ", read {} bytes", bytes.len())?,
            }
        }
        Ok(())
    }
}
