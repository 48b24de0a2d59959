//! Modes of a sensor, and when their conversions end.

use crate::registers::Registers;

/// Start from standby, and start of the analog part (µs).
const STANDBY_US: u64 = 220;
const ACTIVE_US: u64 = 360;
/// End of a conversion (µs).
const END_US: u64 = 100;

/// The mode of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mode {
    /// Nothing is converted.
    Idle,
    /// Sets are converted one after the other.
    Burst(Schedule),
    /// One set is converted.
    Single(Schedule),
}

/// When a mode converts what.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Schedule {
    /// The quantities, as the nibble of commands.
    pub(crate) axes: u8,
    /// Start of the first set (ns).
    start_ns: f64,
    /// Time from the end of the start to the data (ns).
    set_ns: f64,
    /// Time from set to set (ns).
    period_ns: f64,
    /// Conversion of the temperature, or 0 (ns).
    temperature_ns: f64,
    /// Conversion of an axis (ns).
    axis_ns: f64,
}

impl Schedule {
    /// The schedule after a command at a time. `clock_ratio` is the sensor's oscillator.
    pub(crate) fn new(registers: &Registers, axes: u8, command_ns: u64, clock_ratio: f64) -> Self {
        let ns = |us: u64| 1e3 * us as f64 / clock_ratio;
        let temperature_us = if axes & 1 == 0 { 0 } else { registers.temperature_us() };
        let set_us = u64::from((axes & 0xE).count_ones()) * registers.axis_us() + temperature_us + END_US;
        let pause_us = match registers.interval_us() {
            0 => 0,
            interval_us => interval_us + ACTIVE_US,
        };
        Self {
            axes,
            start_ns: command_ns as f64 + ns(STANDBY_US + ACTIVE_US),
            set_ns: ns(set_us),
            period_ns: ns(set_us + pause_us),
            temperature_ns: ns(temperature_us),
            axis_ns: ns(registers.axis_us()),
        }
    }

    /// Number of the last set that ended until a time, from 0.
    pub(crate) fn last_set(&self, time_ns: u64) -> Option<u64> {
        let elapsed_ns = time_ns as f64 - self.start_ns - self.set_ns;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is not negative and below 2^53")]
        (elapsed_ns >= 0.0).then(|| (elapsed_ns / self.period_ns) as u64)
    }

    /// Moves all later conversions by a duration, as when the oscillator stood still.
    pub(crate) fn postpone(&mut self, duration_ns: u64) {
        self.start_ns += duration_ns as f64;
    }

    /// Start and duration of the conversion of an axis in a set (ns). Sets convert T, X, Y and Z in this order.
    pub(crate) fn axis_window(&self, set: u64, axis: usize) -> (f64, f64) {
        let before = (self.axes & 0xE & ((2 << axis) - 1)).count_ones();
        let set_start_ns = self.start_ns + set as f64 * self.period_ns;
        (set_start_ns + self.temperature_ns + f64::from(before) * self.axis_ns, self.axis_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_end_after_the_times_of_the_data_sheet() {
        let mut registers = Registers::new(0);
        registers.set(2, 0x000E);
        let schedule = Schedule::new(&registers, 0b0100, 1_000, 1.0);
        let first_end_ns = 1_000 + 1_000 * (220 + 360 + 2627 + 100);
        assert_eq!(schedule.last_set(first_end_ns - 1), None);
        assert_eq!(schedule.last_set(first_end_ns), Some(0));
        assert_eq!(schedule.last_set(first_end_ns + 2_727_000 - 1), Some(0));
        assert_eq!(schedule.last_set(first_end_ns + 2_727_000), Some(1));
    }

    #[test]
    fn windows_follow_each_other_and_end_before_the_data() {
        let schedule = Schedule::new(&Registers::new(0), 0b1111, 0, 0.9);
        let windows = [0, 1, 2].map(|axis| schedule.axis_window(7, axis));
        for pair in windows.windows(2) {
            assert!((pair[0].0 + pair[0].1 - pair[1].0).abs() < 1e-3);
        }
        let end_ns = windows[2].0 + windows[2].1 + 100e3 / 0.9;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a time after 0")]
        let at = |ns: f64| schedule.last_set(ns as u64);
        assert_eq!((at(end_ns - 2.0), at(end_ns + 2.0)), (Some(6), Some(7)));
    }
}
