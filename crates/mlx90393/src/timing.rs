//! Times of conversions and of the bring-up.

use crate::checked_settings::CheckedSettings;

/// A time of the sensor's own oscillator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Interval {
    /// The time with the nominal oscillator (µs).
    pub nominal_us: u32,
    /// The time with the slowest permitted oscillator (µs), rounded up.
    pub worst_us: u32,
}

/// Start of a conversion from standby (`TSTBY`), typical and longest (µs).
const STANDBY: Interval = Interval { nominal_us: 220, worst_us: 264 };
/// Start of the analog part (`TACTIVE`), typical and longest (µs).
const ACTIVE: Interval = Interval { nominal_us: 360, worst_us: 432 };
/// End of a conversion (`TCONV_END`), typical and longest (µs).
const END: Interval = Interval { nominal_us: 100, worst_us: 120 };
/// Time for the end of the current mode (ms).
pub(crate) const EXIT_MS: u32 = 1;
/// Time for the reset (ms). The data sheet's longest time is 1.5 ms.
pub(crate) const RESET_MS: u32 = 2;
/// The data sheet's table of output rates is slower than its own formulas by this time per set (µs).
///
/// The text does not explain the difference. Worst cases contain it, so that they agree with the slower statement.
const TABLE_MARGIN_US: u32 = 132;

/// A time with an oscillator that is 10 % slow: 5 % of trim and 5 % of temperature.
const fn slow(nominal_us: u32) -> u32 {
    (nominal_us * 11).div_ceil(10)
}

impl CheckedSettings {
    /// Time of the conversions of one set: temperature and all axes.
    ///
    /// The formulas are those of the data sheet, in microseconds. An axis takes 67 + 64 · 2^OSR · (2 + 2^`DIG_FILT`), and the
    /// temperature takes 67 + 192 · 2^OSR2.
    #[must_use]
    pub fn conversion_time(&self) -> Interval {
        let settings = self.get();
        let axis = 67 + (64 << settings.oversampling.get()) * (2 + (1_u32 << settings.filter.get()));
        let temperature = if settings.axes.t { 67 + (192 << settings.temperature_oversampling.get()) } else { 0 };
        let nominal_us = u32::from(settings.axes.magnetic_count()) * axis + temperature;
        Interval { nominal_us, worst_us: slow(nominal_us + TABLE_MARGIN_US) }
    }

    /// Time from the start of a set in burst mode to the start of the next.
    #[must_use]
    pub fn burst_period(&self) -> Interval {
        let interval_us = self.get().burst_interval.microseconds();
        let start_us = if interval_us > 0 { ACTIVE.nominal_us } else { 0 };
        let nominal_us = self.conversion_time().nominal_us + END.nominal_us + start_us + interval_us;
        Interval { nominal_us, worst_us: slow(nominal_us + TABLE_MARGIN_US) }
    }

    /// Time from a command for a single measurement to its data.
    #[must_use]
    pub fn single_measurement_time(&self) -> Interval {
        let conversion = self.conversion_time();
        Interval {
            nominal_us: STANDBY.nominal_us + ACTIVE.nominal_us + conversion.nominal_us + END.nominal_us,
            worst_us: STANDBY.worst_us + ACTIVE.worst_us + conversion.worst_us + END.worst_us,
        }
    }

    /// Highest rate of reading at which each read finds new data (Hz), even with the slowest permitted oscillator.
    #[must_use]
    pub fn highest_safe_rate(&self) -> f32 {
        1e6 / self.burst_period().worst_us as f32
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::{Axes, BurstInterval, DigitalFilter, Hall, Oversampling, Settings};

    /// The data sheet's table of output rates for T, X, Y, Z with OSR2 = 0 (Hz). Rows are `DIG_FILT`, columns are OSR.
    const OUTPUT_RATES: [[f64; 4]; 8] = [
        [716.9, 493.0, 303.4, 171.5],
        [622.7, 408.0, 241.5, 133.0],
        [493.0, 303.4, 171.5, 91.8],
        [348.0, 200.6, 108.6, 56.6],
        [219.2, 119.6, 62.6, 32.1],
        [125.9, 66.1, 33.9, 17.2],
        [68.0, 34.9, 17.7, 8.9],
        [35.4, 18.0, 9.0, 4.5],
    ];

    /// Rates of continuous burst mode by the formulas (Hz): OSR, `DIG_FILT`, then nominal and 10 % slow for Y, XY and XYZ.
    const BURST_RATES: [(u8, u8, [[u32; 2]; 3]); 13] = [
        (0, 2, [[1815, 1650], [998, 907], [688, 626]]),
        (0, 3, [[1239, 1127], [661, 600], [450, 409]]),
        (0, 4, [[758, 689], [394, 358], [266, 242]]),
        (1, 1, [[1473, 1339], [795, 723], [544, 495]]),
        (1, 2, [[1070, 972], [565, 514], [384, 349]]),
        (1, 3, [[691, 628], [358, 325], [241, 220]]),
        (2, 0, [[1070, 972], [565, 514], [384, 349]]),
        (2, 1, [[840, 763], [438, 398], [296, 270]]),
        (2, 2, [[587, 534], [302, 275], [204, 185]]),
        (2, 3, [[367, 333], [187, 170], [125, 114]]),
        (3, 0, [[587, 534], [302, 275], [204, 185]]),
        (3, 1, [[451, 410], [231, 210], [155, 141]]),
        (3, 2, [[309, 281], [157, 143], [105, 96]]),
    ];

    fn checked(osr: u8, filter: u8, axes: Axes) -> CheckedSettings {
        Settings {
            oversampling: Oversampling::new(osr).unwrap(),
            filter: DigitalFilter::new(filter).unwrap(),
            hall: Hall::TwoPhase,
            axes,
            ..Settings::array()
        }
        .check()
        .unwrap()
    }

    #[test]
    fn the_safe_rate_is_the_data_sheets_output_rate() {
        for (filter, row) in (0..).zip(OUTPUT_RATES) {
            for (osr, table) in (0..).zip(row) {
                let rate = f64::from(checked(osr, filter, Axes::TXYZ).highest_safe_rate());
                // The table has one decimal, and the period is rounded up to a microsecond.
                assert!((rate - table).abs() < 0.05 + 1e-3 * table, "OSR {osr}, DIG_FILT {filter}: {rate} and {table}");
            }
        }
    }

    #[test]
    fn burst_rates_are_those_of_the_formulas() {
        for (osr, filter, rates) in BURST_RATES {
            for (nibble, [nominal, slow]) in [0b0100, 0b0110, 0b1110].into_iter().zip(rates) {
                let period = f64::from(checked(osr, filter, Axes::from_nibble(nibble)).burst_period().nominal_us);
                for (rate, table) in [(1e6 / period, nominal), (1e6 / (1.1 * period), slow)] {
                    assert!((rate - f64::from(table)).abs() <= 1.0, "OSR {osr}, DIG_FILT {filter}: {rate} and {table}");
                }
            }
        }
    }

    #[test]
    fn a_setting_guarantees_300_hz_exactly_if_its_slow_rate_does() {
        for (osr, filter, rates) in BURST_RATES {
            for (nibble, [_, slow]) in [0b0100, 0b0110, 0b1110].into_iter().zip(rates) {
                let result = checked(osr, filter, Axes::from_nibble(nibble)).check_rate(300.0);
                assert_eq!(result.is_ok(), slow >= 300, "OSR {osr}, DIG_FILT {filter}");
            }
        }
    }

    #[test]
    fn a_pause_adds_its_time_and_the_start_of_the_analog_part() {
        let continuous = checked(2, 3, Axes::Y);
        let paused = Settings { burst_interval: BurstInterval::new(63).unwrap(), ..*continuous.get() }.check().unwrap();
        let added = paused.burst_period().nominal_us - continuous.burst_period().nominal_us;
        assert_eq!(added, 1_260_000 + 360);
    }

    #[test]
    fn a_single_measurement_starts_from_standby() {
        let settings = checked(2, 3, Axes::Y);
        assert_eq!(settings.conversion_time().nominal_us, 67 + 64 * 4 * 10);
        assert_eq!(settings.single_measurement_time().nominal_us, 220 + 360 + 2627 + 100);
    }
}
