//! Commands, and the errors of commands.

use crate::register::Register;
use crate::status::Status;
use core::fmt;
use thiserror::Error;

/// Starts burst mode. The low nibble selects the quantities.
pub(crate) const START_BURST: u8 = 0x10;
/// Reads a measurement. The low nibble selects the quantities.
pub(crate) const READ_MEASUREMENT: u8 = 0x40;
/// Reads a register. The address of the register follows.
pub(crate) const READ_REGISTER: u8 = 0x50;
/// Writes a register in volatile memory. The value and then the address follow.
pub(crate) const WRITE_REGISTER: u8 = 0x60;
/// Ends the current mode.
pub(crate) const EXIT: u8 = 0x80;
/// Resets the sensor. It is the only command without an answer.
pub(crate) const RESET: u8 = 0xF0;

/// A step of the communication with a sensor, for errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Ending the current mode (`EX`).
    Exit,
    /// The reset (`RT`).
    Reset,
    /// Reading a register (`RR`).
    ReadRegister(Register),
    /// Writing a register (`WR`).
    WriteRegister(Register),
    /// Starting burst mode (`SB`).
    StartBurst,
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exit => f.write_str("ending the current mode"),
            Self::Reset => f.write_str("the reset"),
            Self::ReadRegister(register) => write!(f, "reading register {}", register.get()),
            Self::WriteRegister(register) => write!(f, "writing register {}", register.get()),
            Self::StartBurst => f.write_str("starting burst mode"),
        }
    }
}

/// An error of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CommandError<E> {
    /// The bus reports an error.
    #[error("at {step}, the bus reports {error:?}. Check the address, the wiring and the supply")]
    Bus {
        /// The step.
        step: Step,
        /// The error of the bus.
        error: E,
    },
    /// The sensor rejected the command. In burst mode it accepts no access to registers.
    #[error("the sensor rejected {step}, status {status}. Stop it first, and reset it if this repeats")]
    Rejected {
        /// The step.
        step: Step,
        /// The status.
        status: Status,
    },
}
