//! Measurements.

use crate::axes::Axis;
use crate::checked_settings::CheckedSettings;
use crate::raw_read::RawRead;
use crate::read_error::ReadError;
use crate::settings::Resolution;
use crate::status::Status;
use crate::wrap_watch::WrapWatch;
use core::convert::Infallible;

/// One measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measurement {
    /// The status.
    pub status: Status,
    /// The received bytes. [`decode`] gives the measurement again.
    pub raw: RawRead,
    /// Signed counts of X, if it was converted.
    pub x: Option<i32>,
    /// Signed counts of Y, if it was converted.
    pub y: Option<i32>,
    /// Signed counts of Z, if it was converted.
    pub z: Option<i32>,
    /// Code of the temperature, if it was converted.
    pub temperature: Option<u16>,
    settings: CheckedSettings,
    /// True for each axis whose counts have wrapped.
    has_wrapped: [bool; 3],
}

impl Measurement {
    /// Signed counts of an axis, if it was converted.
    #[must_use]
    pub const fn counts(&self, axis: Axis) -> Option<i32> {
        match axis {
            Axis::X => self.x,
            Axis::Y => self.y,
            Axis::Z => self.z,
        }
    }

    /// The field along an axis (µT), if it was converted. The sensor's own offset is not removed.
    #[must_use]
    pub fn field_microtesla(&self, axis: Axis) -> Option<f32> {
        // Counts have at most 17 bits, so the conversion is exact.
        self.counts(axis).map(|counts| counts as f32 * self.settings.field_per_count_microtesla(axis))
    }

    /// The temperature of the chip (°C), if it was converted. Its linearity is ±3 °C.
    #[must_use]
    pub fn temperature_celsius(&self) -> Option<f32> {
        self.temperature.map(|code| 25.0 + (f32::from(code) - 46_244.0) / 45.2)
    }

    /// True if the counts of an axis are at the end of the output range, so that the field may be larger, or have wrapped.
    ///
    /// With [`Resolution::R0`] and [`Resolution::R1`], the sensor gives the lower 16 bits of a field beyond the range.
    /// [`Sensor::read`](crate::Sensor::read) notices this by a jump of more than half the range since the last measurement.
    /// A measurement of [`decode`] knows no other one, so it notices only the end of the range.
    ///
    /// It is false if the axis was not converted.
    #[must_use]
    pub fn is_saturated(&self, axis: Axis) -> bool {
        self.has_wrapped[axis as usize] || self.is_at_end(axis)
    }

    /// Follows the axes that can wrap.
    pub(crate) fn watch(mut self, watches: &mut [WrapWatch; 3]) -> Self {
        for (axis, watch) in Axis::ALL.into_iter().zip(watches) {
            let can_wrap = matches!(self.settings.get().resolution.of(axis), Resolution::R0 | Resolution::R1);
            if let Some(counts) = self.counts(axis)
                && can_wrap
            {
                self.has_wrapped[axis as usize] = watch.has_wrapped(counts, self.is_at_end(axis));
            }
        }
        self
    }

    fn is_at_end(&self, axis: Axis) -> bool {
        let (lowest, highest) = match self.settings.get().resolution.of(axis) {
            Resolution::R0 | Resolution::R1 => (-0x8000, 0x7FFF),
            Resolution::R2 => (-22_000, 22_000),
            Resolution::R3 => (-11_000, 11_000),
        };
        self.counts(axis).is_some_and(|counts| counts <= lowest || counts >= highest)
    }
}

/// Decodes the answer to a read, for instance a recorded one.
///
/// # Errors
/// [`ReadError`], except for [`ReadError::Bus`].
pub fn decode(settings: &CheckedSettings, bytes: &[u8]) -> Result<Measurement, ReadError<Infallible>> {
    let raw = RawRead::from_bytes(bytes);
    let status = raw.status();
    let axes = settings.get().axes;
    if bytes.len() != usize::from(axes.answer_length()) || status.is_impossible() {
        return Err(ReadError::Garbled { status, raw });
    }
    // A reset also ends burst mode, so it is tested first.
    if status.reset() {
        return Err(ReadError::Reset { status, raw });
    }
    if !status.burst_mode() {
        return Err(ReadError::ModeLost { status, raw });
    }
    if status.error() {
        return Err(ReadError::Stale { status, raw });
    }
    if status.length() != 2 * axes.count() {
        return Err(ReadError::Garbled { status, raw });
    }
    let data = bytes.get(1..).unwrap_or_default();
    let mut words = data.as_chunks().0.iter().map(|word| u16::from_be_bytes(*word));
    let mut next = |selected: bool| if selected { words.next() } else { None };
    let (t, x, y, z) = (next(axes.t), next(axes.x), next(axes.y), next(axes.z));
    let counts = |axis, word: Option<u16>| word.map(|word| signed_counts(settings, axis, word));
    Ok(Measurement {
        status,
        raw,
        x: counts(Axis::X, x),
        y: counts(Axis::Y, y),
        z: counts(Axis::Z, z),
        temperature: t,
        settings: *settings,
        has_wrapped: [false; 3],
    })
}

/// The signed counts of a word. The code depends on resolution and temperature compensation.
fn signed_counts(settings: &CheckedSettings, axis: Axis, word: u16) -> i32 {
    let settings = settings.get();
    match (settings.resolution.of(axis), settings.temperature_compensation) {
        (Resolution::R0 | Resolution::R1, false) => i32::from(word.cast_signed()),
        (Resolution::R0 | Resolution::R1, true) | (Resolution::R2, _) => i32::from(word) - 0x8000,
        (Resolution::R3, _) => i32::from(word) - 0x4000,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::{Axes, Resolutions, Settings};
    use proptest::prelude::*;

    fn one_axis(resolution: Resolution, temperature_compensation: bool) -> CheckedSettings {
        Settings { resolution: Resolutions::all(resolution), temperature_compensation, ..Settings::array() }
            .check()
            .unwrap()
    }

    fn y(settings: &CheckedSettings, word: u16) -> Measurement {
        let [high, low] = word.to_be_bytes();
        decode(settings, &[0x80, high, low]).unwrap()
    }

    #[test]
    fn a_zero_field_has_the_code_of_the_data_sheet() {
        for (resolution, compensation, code) in [
            (Resolution::R0, false, 0),
            (Resolution::R1, false, 0),
            (Resolution::R2, false, 32768),
            (Resolution::R3, false, 16384),
            (Resolution::R0, true, 32768),
            (Resolution::R1, true, 32768),
        ] {
            let settings = one_axis(resolution, compensation);
            assert_eq!(y(&settings, code).y, Some(0));
            assert_eq!(y(&settings, code + 1).y, Some(1));
            assert_eq!(y(&settings, code.wrapping_sub(1)).y, Some(-1));
        }
    }

    #[test]
    fn the_ends_of_the_output_range_are_saturated() {
        for (resolution, compensation, lowest, highest) in [
            (Resolution::R0, false, 0x8000, 0x7FFF),
            (Resolution::R1, true, 0x0000, 0xFFFF),
            (Resolution::R2, false, 32768 - 22_000, 32768 + 22_000),
            (Resolution::R3, false, 16384 - 11_000, 16384 + 11_000),
        ] {
            let settings = one_axis(resolution, compensation);
            for (end, inside) in [(lowest, lowest + 1), (highest, highest - 1)] {
                assert!(y(&settings, end).is_saturated(Axis::Y));
                assert!(!y(&settings, inside).is_saturated(Axis::Y));
            }
        }
    }

    #[test]
    fn an_axis_that_was_not_converted_has_no_value() {
        let measurement = y(&one_axis(Resolution::R0, false), 0x7FFF);
        assert_eq!((measurement.x, measurement.z, measurement.temperature), (None, None, None));
        assert_eq!(measurement.field_microtesla(Axis::X), None);
        assert!(!measurement.is_saturated(Axis::X));
    }

    #[test]
    fn quantities_come_in_the_order_temperature_x_y_z() {
        let settings = Settings { axes: Axes::TXYZ, ..Settings::array() }.check().unwrap();
        let measurement = decode(&settings, &[0x83, 0xB4, 0xA4, 0, 1, 0xFF, 0xFE, 0, 3]).unwrap();
        assert_eq!((measurement.x, measurement.y, measurement.z), (Some(1), Some(-2), Some(3)));
        assert_eq!(measurement.temperature_celsius(), Some(25.0));
    }

    #[test]
    fn a_stale_read_is_told_from_a_lost_mode_and_from_a_reset() {
        let settings = Settings::array().check().unwrap();
        let error = |status: u8| decode(&settings, &[status, 0, 0]).unwrap_err();
        assert!(matches!(error(0x90), ReadError::Stale { .. }));
        assert!(matches!(error(0x10), ReadError::ModeLost { .. }));
        assert!(matches!(error(0x00), ReadError::ModeLost { .. }));
        assert!(matches!(error(0x14), ReadError::Reset { .. }));
        assert!(matches!(error(0x84), ReadError::Reset { .. }));
        assert!(matches!(error(0xFF), ReadError::Garbled { .. }));
        assert!(matches!(error(0x81), ReadError::Garbled { .. }), "one axis has two bytes, not four");
    }

    #[test]
    fn a_corrected_bit_is_no_error() {
        let measurement = decode(&Settings::array().check().unwrap(), &[0x88, 0, 5]).unwrap();
        assert!(measurement.status.corrected_bit());
        assert_eq!(measurement.y, Some(5));
    }

    proptest! {
        #[test]
        fn no_bytes_panic_and_every_result_keeps_them(nibble in 1_u8..16, bytes in prop::collection::vec(any::<u8>(), 0..12)) {
            let settings = Settings { axes: Axes::from_nibble(nibble), ..Settings::array() }.check().unwrap();
            let kept = bytes.len().min(9);
            match decode(&settings, &bytes) {
                Ok(measurement) => {
                    prop_assert_eq!(measurement.raw.as_bytes(), &bytes[..]);
                    prop_assert_eq!(decode(&settings, measurement.raw.as_bytes()), Ok(measurement));
                }
                Err(error) => prop_assert_eq!(error.raw().unwrap().as_bytes(), &bytes[..kept]),
            }
        }
    }
}
