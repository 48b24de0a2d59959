//! Driver for the magnetic field sensor MLX90393 over I²C.
//!
//! The driver is made for whisker arrays: several sensors on one bus, each read several hundred times a second. Every
//! method borrows the bus, so sensors can share it. A [`Sensor::read`] is one transaction and never sleeps.
//!
//! `sensor.rs` has the transactions, `register.rs` and `settings.rs` the registers, `status.rs` and `measurement.rs` what a read
//! means. A new setting is a field of [`Settings`] with its check in `checked_settings.rs`. The emulator shares no code with the
//! driver, so that each tests the other: change both.
//!
//! ```
//! use embedded_hal_mock::eh1::{delay::NoopDelay, i2c::{Mock, Transaction}};
//! use vibrissa_mlx90393::{Address, Axis, ReadError, Sensor, Settings};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Settings are checked before anything is written. 300 reads per second must all be fresh.
//! let settings = Settings::array().check()?;
//! settings.check_rate(300.0)?;
//!
//! // On a robot, `bus` is the I²C bus of the board. Here, a mock expects the exact transactions.
//! # let a = 0x0C;
//! # let rr = |register: u8, high, low, status| Transaction::write_read(a, vec![0x50, register << 2], vec![status, high, low]);
//! # let wr = |register: u8, high, low| Transaction::write_read(a, vec![0x60, high, low, register << 2], vec![0x00]);
//! # let expected = [
//! #     Transaction::write_read(a, vec![0x80], vec![0x00]),
//! #     Transaction::write(a, vec![0xF0]),
//! #     rr(0, 0x5A, 0x0C, 0x04),
//! #     wr(0, 0x5A, 0x7C), wr(2, 0x00, 0x0E), wr(1, 0x01, 0x00),
//! #     rr(0, 0x5A, 0x7C, 0), rr(2, 0x00, 0x0E, 0), rr(1, 0x01, 0x00, 0),
//! #     Transaction::write_read(a, vec![0x14], vec![0x80]),
//! #     Transaction::write_read(a, vec![0x44], vec![0x90, 0, 0]),
//! #     Transaction::write_read(a, vec![0x44], vec![0x80, 0xFF, 0x9C]),
//! # ];
//! # let mut bus = Mock::new(&expected);
//! # let mut delay = NoopDelay::new();
//! let mut sensor = Sensor::new(Address::new(0x0C)?, settings);
//! sensor.start(&mut bus, &mut delay)?;
//!
//! // The first conversion has not ended, so there is no new data.
//! assert!(matches!(sensor.read(&mut bus), Err(ReadError::Stale { .. })));
//! // Later, a read gives the field.
//! let measurement = sensor.read(&mut bus)?;
//! assert_eq!(measurement.y, Some(-100));
//! let field = measurement.field_microtesla(Axis::Y).ok_or("Y is not selected")?;
//! assert!((field + 15.0).abs() < 1e-3);
//! # bus.done();
//! # Ok(())
//! # }
//! ```
//!
//! # Errors of a read
//!
//! | error | cause | reaction |
//! |---|---|---|
//! | [`ReadError::Stale`] | no conversion has ended since the last read | use the last value |
//! | [`ReadError::ModeLost`] | the sensor is not in burst mode | start it again |
//! | [`ReadError::Reset`] | the sensor was reset, for instance by a drop of its supply | start it again |
//! | [`ReadError::Garbled`] | the status is impossible | discard the bytes |
//! | [`ReadError::Bus`] | the bus reports an error | check the wiring |
//!
//! The sensor's protocol has no checksum. A wrong bit in the data cannot be detected.
//!
//! # Rates
//!
//! A sensor has its own oscillator, which is up to 10 % slow or fast. Poll it more slowly than its slowest burst rate, and every read is
//! fresh. [`CheckedSettings::check_rate`] tests this. The bus limits the rate too: [`measure_bus_clock`] finds the clock
//! that the bus really has, and [`round_time`] the time of reading all sensors once.
//!
//! Formulas and figures are those of the data sheet 3901090393, Rev 007.
#![no_std]

mod address;
mod axes;
mod bus_clock;
mod checked_settings;
mod code;
mod command;
mod measurement;
mod raw_read;
mod read_error;
mod register;
mod sensitivity;
mod sensor;
mod settings;
mod start;
mod status;
mod timing;
mod wrap_watch;

pub use address::{Address, InvalidAddress};
pub use axes::{Axes, Axis};
pub use bus_clock::{BusClock, BusClockError, measure_bus_clock, read_clocks, round_time};
pub use checked_settings::{CheckedSettings, Refusal};
pub use code::{BurstInterval, DigitalFilter, Gain, OutOfRange, Oversampling};
pub use command::{CommandError, Step};
pub use measurement::{Measurement, decode};
pub use raw_read::RawRead;
pub use read_error::ReadError;
pub use register::Register;
pub use sensor::Sensor;
pub use settings::{Hall, Resolution, Resolutions, Settings, TriggerPin};
pub use start::{StartError, StartReport};
pub use status::Status;
pub use timing::Interval;
