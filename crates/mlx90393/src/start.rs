//! The start of a sensor.

use crate::command::CommandError;
use crate::register::Register;
use crate::status::Status;
use thiserror::Error;

/// State of a sensor after its start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StartReport {
    /// Registers 0, 1 and 2, as read back.
    pub registers: [u16; 3],
    /// Bits 15 to 9 of register 0, which are calibrated in the factory. They identify the chip only roughly.
    pub factory_trim: u8,
    /// True if the sensor corrected a wrong bit of its memory. Replace the sensor if this persists.
    pub corrected_bit: bool,
    /// The status of the command that started burst mode.
    pub burst_status: Status,
}

/// An error of [`Sensor::start`](crate::Sensor::start).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum StartError<E> {
    /// A command failed.
    #[error("{0}")]
    Command(CommandError<E>),
    /// The status after the reset does not report the reset.
    #[error(
        "no reset is reported, status {status}. Check that the device at this address is an MLX90393 and that nothing else reads it"
    )]
    NoReset {
        /// The status.
        status: Status,
    },
    /// A register does not contain what was written.
    #[error(
        "register {} has {read:#06x} after {written:#06x} was written. Check the supply and the wiring, and that nothing else writes it",
        register.get()
    )]
    ReadBack {
        /// The register.
        register: Register,
        /// The written value.
        written: u16,
        /// The value that was read back.
        read: u16,
    },
    /// Burst mode did not start.
    #[error("burst mode did not start, status {status}. Repeat the start, and check the supply if this repeats")]
    BurstRefused {
        /// The status.
        status: Status,
    },
}

impl<E> From<CommandError<E>> for StartError<E> {
    fn from(error: CommandError<E>) -> Self {
        Self::Command(error)
    }
}
