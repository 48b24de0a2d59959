//! What a bus needs of a sensor.

use crate::fault::SensorFault;
use crate::field::FieldSource;

/// A sensor that an [`EmulatedBus`](crate::EmulatedBus) drives. Times are in nanoseconds.
pub trait Emulated {
    /// The 7-bit address.
    fn address(&self) -> u8;

    /// Adds a fault. A sensor ignores one that it cannot have.
    fn inject(&mut self, fault: SensorFault, now_ns: u64);

    /// Removes all faults.
    fn clear(&mut self, now_ns: u64);

    /// True if the sensor acknowledges its address.
    fn acknowledges(&mut self, now_ns: u64) -> bool;

    /// Executes a command that ends now.
    fn write(&mut self, command: &[u8], now_ns: u64, field: &mut dyn FieldSource);

    /// The byte with this index of the answer.
    fn read(&mut self, index: usize) -> u8;

    /// Ends a read.
    fn end_read(&mut self, now_ns: u64);
}
