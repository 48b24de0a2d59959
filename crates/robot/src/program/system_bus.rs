//! An I²C bus of the system.

use std::path::{Path, PathBuf};

use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use rppal::i2c::Error as RppalError;

use super::system_clock::SystemClock;
use crate::array::Bus;

/// An I²C bus of the system, through rppal. Transfers that write and then read have a repeated start.
#[derive(Debug)]
pub struct SystemBus {
    bus: rppal::i2c::I2c,
    clock: SystemClock,
    address: Option<u8>,
}

/// An error of a bus of the system.
#[derive(Debug, thiserror::Error)]
pub enum SystemBusError {
    /// The path is not that of an I²C bus.
    #[error("{} is not an I²C bus; give a path such as /dev/i2c-1", path.display())]
    Path {
        /// The path.
        path: PathBuf,
    },
    /// The bus cannot be opened.
    #[error(
        "{} cannot be opened: {cause}; enable the bus in config.txt, and add the user to the group i2c",
        path.display()
    )]
    Open {
        /// The path.
        path: PathBuf,
        /// The cause.
        cause: RppalError,
    },
    /// A transfer has failed.
    #[error("{0}")]
    Transfer(#[from] RppalError),
    /// A sequence of operations that this bus does not have.
    #[error("the bus does not support this sequence of operations; write, read, or write and then read")]
    Unsupported,
}

/// Error numbers of Linux for a device that does not answer.
const NOT_ACKNOWLEDGED: [i32; 2] = [6, 121];

impl embedded_hal::i2c::Error for SystemBusError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Transfer(RppalError::Io(error))
                if error.raw_os_error().is_some_and(|number| NOT_ACKNOWLEDGED.contains(&number)) =>
            {
                ErrorKind::NoAcknowledge(NoAcknowledgeSource::Unknown)
            }
            _ => ErrorKind::Other,
        }
    }
}

impl SystemBus {
    /// Opens a bus by its device file, such as `/dev/i2c-1`.
    ///
    /// # Errors
    /// [`SystemBusError`] if it is no bus, or if it cannot be opened.
    pub fn open(path: &Path, clock: SystemClock) -> Result<Self, SystemBusError> {
        let number =
            path.to_str().and_then(|path| path.strip_prefix("/dev/i2c-")).and_then(|number| number.parse().ok());
        let number: u8 = number.ok_or_else(|| SystemBusError::Path { path: path.to_owned() })?;
        let bus =
            rppal::i2c::I2c::with_bus(number).map_err(|cause| SystemBusError::Open { path: path.to_owned(), cause })?;
        Ok(Self { bus, clock, address: None })
    }

    fn select(&mut self, address: u8) -> Result<(), SystemBusError> {
        if self.address != Some(address) {
            self.bus.set_slave_address(u16::from(address))?;
            self.address = Some(address);
        }
        Ok(())
    }
}

impl ErrorType for SystemBus {
    type Error = SystemBusError;
}

impl I2c for SystemBus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), SystemBusError> {
        self.select(address)?;
        match operations {
            [Operation::Write(bytes)] => self.bus.write(bytes).map(drop)?,
            [Operation::Read(bytes)] => self.bus.read(bytes).map(drop)?,
            [Operation::Write(written), Operation::Read(read)] => self.bus.write_read(written, read)?,
            _ => return Err(SystemBusError::Unsupported),
        }
        Ok(())
    }
}

impl Bus for SystemBus {
    fn now_ns(&self) -> u64 {
        self.clock.now_ns()
    }

    fn pause_ns(&mut self, duration_ns: u64) {
        self.clock.sleep_until_ns(self.clock.now_ns() + duration_ns);
    }
}
