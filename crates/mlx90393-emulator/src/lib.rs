//! Emulator of MLX90393 magnetic field sensors on an I²C bus.
//!
//! An [`EmulatedBus`] implements [`embedded_hal::i2c::I2c`]. It has [`EmulatedSensor`]s, a [`FieldSource`] with the true
//! field, and an [`EmulatedClock`]. A transaction advances the clock by its own time.
//!
//! `sensor.rs` has modes and conversions, `registers.rs` the memory, and `bus.rs` the transactions and their time. A new fault is
//! a variant in `fault.rs`. Nothing here uses the driver, because each tests the other.
//!
//! ```
//! use embedded_hal::i2c::I2c;
//! use vibrissa_mlx90393_emulator::{EmulatedBus, EmulatedSensor, SensorOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // The field is 30 µT along Y at all times and sensors.
//! let mut bus = EmulatedBus::new(|_sensor: usize, _time_ns: u64| [0.0, 30.0, 0.0]);
//! bus.add(EmulatedSensor::new(SensorOptions { address: 0x0C, ..SensorOptions::default() }));
//!
//! // Gain 7 and Hall configuration 0xC, then burst mode of Y with weak filters.
//! let mut status = [0];
//! bus.write_read(0x0C, &[0x60, 0x5A, 0x7C, 0x00], &mut status)?;
//! bus.write_read(0x0C, &[0x60, 0x00, 0x0E, 0x08], &mut status)?;
//! bus.write_read(0x0C, &[0x14], &mut status)?;
//! assert_eq!(status, [0x80]);
//!
//! // Without new data, the status has the error bit. Some milliseconds later, there are 200 counts of 0.15 µT.
//! let mut answer = [0; 3];
//! bus.write_read(0x0C, &[0x44], &mut answer)?;
//! assert_eq!(answer[0], 0x90);
//! bus.clock().advance_ns(5_000_000);
//! bus.write_read(0x0C, &[0x44], &mut answer)?;
//! assert_eq!(answer, [0x80, 0, 200]);
//! # Ok(())
//! # }
//! ```
//!
//! # Time
//!
//! Nothing happens between transactions. A read computes which conversion ended last, and only that conversion is
//! evaluated. An hour of reading therefore costs as much as its reads.
//!
//! # Noise
//!
//! The noise of a conversion is a function of the seed, the number of the start of its mode, and its own number. Reading
//! more or fewer conversions does not change the noise of the others.

mod answer;
mod bus;
mod bus_error;
mod clock;
mod counts;
mod emulated;
mod fault;
mod field;
mod mode;
mod options;
mod registers;
mod sensor;

pub use bus::EmulatedBus;
pub use bus_error::EmulatedBusError;
pub use clock::EmulatedClock;
pub use emulated::Emulated;
pub use fault::{BusFault, SensorFault};
pub use field::FieldSource;
pub use options::SensorOptions;
pub use sensor::EmulatedSensor;
