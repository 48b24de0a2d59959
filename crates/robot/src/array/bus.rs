//! A bus with a clock.

use std::cell::RefCell;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{ErrorType, I2c, Operation};

/// An I²C bus with the clock of the thread that uses it. A call advances this clock by its duration.
pub trait Bus: I2c {
    /// Time since the start of the program (ns).
    fn now_ns(&self) -> u64;

    /// Waits.
    fn pause_ns(&mut self, duration_ns: u64);
}

/// A bus that a driver uses for transfers and for delays at once.
#[derive(Debug)]
pub(crate) struct Port<'b, B>(pub(crate) &'b RefCell<&'b mut B>);

impl<B: Bus> ErrorType for Port<'_, B> {
    type Error = B::Error;
}

impl<B: Bus> I2c for Port<'_, B> {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Self::Error> {
        self.0.borrow_mut().transaction(address, operations)
    }

    fn write_read(&mut self, address: u8, write: &[u8], read: &mut [u8]) -> Result<(), Self::Error> {
        self.0.borrow_mut().write_read(address, write, read)
    }
}

impl<B: Bus> DelayNs for Port<'_, B> {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().pause_ns(u64::from(ns));
    }
}
