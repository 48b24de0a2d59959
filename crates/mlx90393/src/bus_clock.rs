//! The clock of a bus.

use crate::address::Address;
use crate::axes::Axes;
use crate::command::READ_REGISTER;
use crate::register::Register;
use embedded_hal::i2c::I2c;
use thiserror::Error;

/// Number of measured transactions of each length. Their minimum is free of interruptions by other work.
const REPETITIONS: u32 = 64;

/// The clock of a bus, and the time that each transaction takes in addition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BusClock {
    /// Frequency of the clock (Hz).
    pub frequency_hz: u32,
    /// Time of a transaction without its clocks (ns), for instance in the operating system.
    pub overhead_ns: u32,
}

/// An error of [`measure_bus_clock`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum BusClockError<E> {
    /// The bus reports an error.
    #[error("the bus reports {0:?}. Check the address, the wiring and the supply")]
    Bus(E),
    /// Long transactions take no longer than short ones.
    #[error(
        "transactions of different lengths take the same time. Use a finer clock for `now`, and measure without other load"
    )]
    Indistinct,
}

/// Number of clocks of a transaction that writes and then reads: 9 per byte, and start, repeated start and stop.
const fn transaction_clocks(written: u32, read: u32) -> u32 {
    // Each direction begins with the address byte.
    9 * (1 + written + 1 + read) + 3
}

/// Number of bus clocks of a read of these quantities.
#[must_use]
pub const fn read_clocks(axes: Axes) -> u32 {
    transaction_clocks(1, axes.answer_length() as u32)
}

/// Time of reading this many sensors once (µs), rounded up.
///
/// The Raspberry Pi's default clock of 100 kHz is too slow for 300 Hz. Compare the result with the control period.
#[must_use]
pub fn round_time(sensors: u32, axes: Axes, clock: BusClock) -> u32 {
    let frequency = u64::from(clock.frequency_hz.max(1));
    let clocks_ns = (u64::from(read_clocks(axes)) * 1_000_000_000).div_ceil(frequency);
    let round_ns = u64::from(sensors).saturating_mul(clocks_ns + u64::from(clock.overhead_ns));
    u32::try_from(round_ns.div_ceil(1000)).unwrap_or(u32::MAX)
}

/// Measures the clock of a bus with a sensor that is not in burst mode. `now` returns a time in nanoseconds.
///
/// It reads register 0 completely, and again without its value. The difference of the shortest times is that of 18 clocks.
///
/// # Errors
/// [`BusClockError::Bus`], and [`BusClockError::Indistinct`] if the two lengths take the same time.
pub fn measure_bus_clock<I: I2c>(
    bus: &mut I,
    address: Address,
    mut now: impl FnMut() -> u64,
) -> Result<BusClock, BusClockError<I::Error>> {
    let command = [READ_REGISTER, Register::GAIN.get() << 2];
    let mut shortest = |answer: &mut [u8]| {
        let mut shortest_ns = u64::MAX;
        for _ in 0..REPETITIONS {
            let start_ns = now();
            bus.write_read(address.get(), &command, answer).map_err(BusClockError::Bus)?;
            shortest_ns = shortest_ns.min(now().saturating_sub(start_ns));
        }
        Ok(shortest_ns)
    };
    let short_ns = shortest(&mut [0; 1])?;
    let long_ns = shortest(&mut [0; 3])?;

    let (short_clocks, long_clocks) = (transaction_clocks(2, 1), transaction_clocks(2, 3));
    let clocks_ns = long_ns.checked_sub(short_ns).filter(|ns| *ns > 0).ok_or(BusClockError::Indistinct)?;
    let added_clocks = u64::from(long_clocks - short_clocks);
    let short_clocks_ns = clocks_ns.saturating_mul(u64::from(short_clocks)) / added_clocks;
    Ok(BusClock {
        frequency_hz: u32::try_from(added_clocks * 1_000_000_000 / clocks_ns).unwrap_or(u32::MAX),
        overhead_ns: u32::try_from(short_ns.saturating_sub(short_clocks_ns)).unwrap_or(u32::MAX),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use core::cell::Cell;
    use core::convert::Infallible;
    use embedded_hal::i2c::{ErrorType, Operation};
    use proptest::prelude::*;

    /// A bus on which a transaction takes its clocks, an overhead and some interruptions.
    struct TimedBus<'a> {
        now_ns: &'a Cell<u64>,
        frequency_hz: u64,
        overhead_ns: u64,
        transactions: u64,
    }

    impl ErrorType for TimedBus<'_> {
        type Error = Infallible;
    }

    impl I2c for TimedBus<'_> {
        fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), Infallible> {
            let mut clocks = 1;
            for operation in operations {
                let bytes = match operation {
                    Operation::Read(buffer) => buffer.len(),
                    Operation::Write(bytes) => bytes.len(),
                };
                clocks += 1 + 9 * (1 + bytes as u64);
            }
            self.transactions += 1;
            let interruption_ns = if self.transactions.is_multiple_of(4) { 400_000 } else { 0 };
            let time_ns = clocks * 1_000_000_000 / self.frequency_hz + self.overhead_ns + interruption_ns;
            self.now_ns.set(self.now_ns.get() + time_ns);
            Ok(())
        }
    }

    proptest! {
        #[test]
        fn the_clock_and_the_overhead_are_told_apart(frequency_hz in 50_000_u32..1_000_000, overhead_ns in 0_u32..100_000) {
            let now_ns = Cell::new(5);
            let mut bus = TimedBus {
                now_ns: &now_ns, frequency_hz: frequency_hz.into(), overhead_ns: overhead_ns.into(), transactions: 0,
            };
            let clock = measure_bus_clock(&mut bus, Address::new(0x0C).unwrap(), || now_ns.get()).unwrap();
            prop_assert!(clock.frequency_hz.abs_diff(frequency_hz) <= frequency_hz / 5000);
            prop_assert!(clock.overhead_ns.abs_diff(overhead_ns) <= 10);
        }
    }

    #[test]
    fn a_clock_that_stands_still_is_an_error() {
        let now_ns = Cell::new(0);
        let mut bus = TimedBus { now_ns: &now_ns, frequency_hz: 400_000, overhead_ns: 0, transactions: 0 };
        let result = measure_bus_clock(&mut bus, Address::new(0x0C).unwrap(), || 0);
        assert_eq!(result, Err(BusClockError::Indistinct));
    }

    #[test]
    fn a_round_takes_the_clocks_of_the_bus_protocol() {
        assert_eq!([Axes::Y, Axes::XYZ, Axes::TXYZ].map(read_clocks), [57, 93, 111]);
        let ideal = |frequency_hz| BusClock { frequency_hz, overhead_ns: 0 };
        assert_eq!(round_time(3, Axes::Y, ideal(100_000)), 1710);
        assert_eq!(round_time(3, Axes::XYZ, ideal(100_000)), 2790);
        assert_eq!(round_time(3, Axes::Y, ideal(400_000)), 428);
        assert_eq!(round_time(3, Axes::XYZ, ideal(400_000)), 698);
        assert_eq!(round_time(3, Axes::TXYZ, ideal(400_000)), 833);
        assert_eq!(round_time(6, Axes::Y, BusClock { frequency_hz: 400_000, overhead_ns: 50_000 }), 1155);
    }
}
