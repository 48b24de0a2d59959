//! What every sensor provides.

#[cfg(feature = "emulation")]
use vibrissa_mlx90393_emulator::{Emulated, SensorFault};
use vibrissa_runtime::units::Key;

use super::BusClock;
use crate::array::{BoardReading, Bus, ReadingState};

/// Settings, an address or a board that cannot be used. The message says what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub String);

impl Refused {
    /// The refusal by a driver.
    pub(super) fn by(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// The settings of a sensor in the configuration. Its default has every key.
pub trait Section: Default {
    /// The sensor with checked settings.
    type Model: Sensor;

    /// The numbers (SI) with their keys, whose ranges are checked. None if the reader of the section has checked them.
    fn numbers(&self) -> Vec<(f64, Key)> {
        Vec::new()
    }

    /// Address of the first board on a bus. The addresses of the others follow.
    fn first_address(&self) -> u8;

    /// The sensor with these settings, for a sample rate (Hz).
    ///
    /// # Errors
    /// [`Refused`] if the sensor does not permit them, or if it may be slower than the sample rate.
    fn model(&self, sample_rate: f64) -> Result<Self::Model, Refused>;
}

/// A sensor with checked settings. It measures the field along one axis in counts.
pub trait Sensor: Copy {
    /// The driver of one board.
    type Driver: SensorDriver;

    /// Field per count (µT).
    fn microtesla_per_count(&self) -> f64;

    /// Largest difference between two values (counts) of a whisker at rest. A larger one is a motion.
    fn largest_rest_spread(&self) -> u32;

    /// Time of a conversion (µs). A value is as old as this when it is read: half of it for its mean age, and half for its
    /// mean.
    fn conversion_us(&self) -> u32;

    /// Time (µs) of reading this many boards once, rounded up.
    fn round_us(&self, boards: u32, clock: BusClock) -> u32;

    /// The result of a read with these bytes. A replay repeats it.
    fn decode(&self, received: &[u8]) -> ReadingState;

    /// Measures the clock of a bus with the board at an address, which has not been started. `now_ns` returns a time (ns).
    ///
    /// # Errors
    /// [`Refused`] if the bus reports an error, or if the times tell nothing.
    fn bus_clock<B: Bus>(&self, bus: &mut B, address: u8, now_ns: impl FnMut() -> u64) -> Result<BusClock, Refused>;

    /// The driver of the board with this address.
    ///
    /// # Errors
    /// [`Refused`] if the sensor cannot have the address.
    fn driver(&self, address: u8) -> Result<Self::Driver, Refused>;

    /// An emulated board.
    #[cfg(feature = "emulation")]
    fn emulated(&self, board: &EmulatedBoard) -> Box<dyn Emulated>;

    /// The fault of a board whose answers are impossible.
    #[cfg(feature = "emulation")]
    fn garbled(&self) -> SensorFault;
}

/// The driver of one board. It never waits in [`read`](Self::read).
pub trait SensorDriver {
    /// Brings up the board. It can be repeated at any time.
    ///
    /// # Errors
    /// [`Refused`] if the board does not answer as it should.
    fn start<B: Bus>(&mut self, bus: &mut B) -> Result<(), Refused>;

    /// Reads the newest value in one transaction.
    fn read<B: Bus>(&mut self, bus: &mut B) -> BoardReading;
}

/// Properties of an emulated board.
#[cfg(feature = "emulation")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmulatedBoard {
    /// Address on the bus.
    pub address: u8,
    /// Index for the source of the field.
    pub field_index: usize,
    /// How far the board differs from a nominal one, from -1 to 1.
    pub deviation: f64,
    /// Standard deviation of the noise (µT).
    pub noise_microtesla: f64,
    /// Seed of the noise.
    pub seed: u64,
}
