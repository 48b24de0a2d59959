//! Settings that the sensor permits.

use crate::axes::Axis;
use crate::settings::{Hall, Resolution, Settings, TriggerPin};
use thiserror::Error;

/// Settings that the data sheet permits. [`Settings::check`] creates them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CheckedSettings(Settings);

/// A reason to refuse settings.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Refusal {
    /// Nothing is converted.
    #[error("no quantity is selected. Select at least one of t, x, y and z")]
    NoAxis,
    /// The filter is too short for the spinning of the Hall plates.
    #[error(
        "HALLCONF 0xC forbids OSR {oversampling} with DIG_FILT {filter}. Increase DIG_FILT to {permitted}, or use HALLCONF 0x0"
    )]
    ForbiddenFilter {
        /// Code of `OSR`.
        oversampling: u8,
        /// Code of `DIG_FILT`.
        filter: u8,
        /// The lowest permitted `DIG_FILT` with this `OSR`.
        permitted: u8,
    },
    /// Temperature compensation needs a finer resolution.
    #[error(
        "temperature compensation needs RES 0 or 1, but axis {axis:?} has RES 2 or 3. Disable it, or set a finer resolution"
    )]
    CompensationResolution {
        /// A selected axis with a coarse resolution.
        axis: Axis,
    },
    /// The pin cannot be an input and an output.
    #[error(
        "an external trigger needs the pin as input. Set the trigger pin to Input, or disable the external trigger"
    )]
    TriggerPinIsOutput,
    /// The rate is no positive number.
    #[error("a sample rate is a positive number of hertz, not {hz}")]
    InvalidRate {
        /// The refused rate (Hz).
        hz: f32,
    },
    /// A slow sensor would not have new data at each read.
    #[error(
        "a slow sensor converts only {highest_hz} times per second, fewer than {hz}. Reduce OSR, DIG_FILT, the interval or the axes"
    )]
    TooSlow {
        /// The requested rate (Hz).
        hz: f32,
        /// The highest rate with these settings (Hz).
        highest_hz: f32,
    },
}

impl Settings {
    /// Checks the settings against the rules of the data sheet.
    ///
    /// # Errors
    /// A [`Refusal`] with the first broken rule.
    pub fn check(self) -> Result<CheckedSettings, Refusal> {
        if self.axes.count() == 0 {
            return Err(Refusal::NoAxis);
        }
        // The pairs marked red in the data sheet's table of conversion times.
        let permitted = match (self.hall, self.oversampling.get()) {
            (Hall::FourPhase, 0) => 2,
            (Hall::FourPhase, 1) => 1,
            _ => 0,
        };
        if self.axes.magnetic_count() > 0 && self.filter.get() < permitted {
            return Err(Refusal::ForbiddenFilter {
                oversampling: self.oversampling.get(),
                filter: self.filter.get(),
                permitted,
            });
        }
        if self.temperature_compensation {
            for axis in Axis::ALL {
                let coarse = matches!(self.resolution.of(axis), Resolution::R2 | Resolution::R3);
                if self.axes.has(axis) && coarse {
                    return Err(Refusal::CompensationResolution { axis });
                }
            }
        }
        if self.external_trigger && self.trigger_pin == TriggerPin::DataReady {
            return Err(Refusal::TriggerPinIsOutput);
        }
        Ok(CheckedSettings(self))
    }
}

impl CheckedSettings {
    /// The settings.
    #[must_use]
    pub const fn get(&self) -> &Settings {
        &self.0
    }

    /// Checks that a read at this rate always finds new data, even if the sensor's oscillator is 10 % slow.
    ///
    /// # Errors
    /// [`Refusal::TooSlow`] above [`CheckedSettings::highest_safe_rate`], and [`Refusal::InvalidRate`].
    pub fn check_rate(&self, hz: f32) -> Result<(), Refusal> {
        if !(hz.is_finite() && hz > 0.0) {
            return Err(Refusal::InvalidRate { hz });
        }
        let highest_hz = self.highest_safe_rate();
        if hz > highest_hz { Err(Refusal::TooSlow { hz, highest_hz }) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::{Axes, BurstInterval, DigitalFilter, Oversampling, Resolutions};

    #[test]
    fn exactly_the_red_pairs_of_the_data_sheet_are_refused_with_hallconf_0xc() {
        for osr in 0..4 {
            for filter in 0..8 {
                let settings = |hall| Settings {
                    oversampling: Oversampling::new(osr).unwrap(),
                    filter: DigitalFilter::new(filter).unwrap(),
                    hall,
                    ..Settings::array()
                };
                let red = [(0, 0), (0, 1), (1, 0)].contains(&(osr, filter));
                assert_eq!(settings(Hall::FourPhase).check().is_err(), red, "OSR {osr}, DIG_FILT {filter}");
                assert!(settings(Hall::TwoPhase).check().is_ok());
            }
        }
    }

    #[test]
    fn a_refused_filter_names_a_permitted_one() {
        for osr in 0..2 {
            let mut settings = Settings {
                oversampling: Oversampling::new(osr).unwrap(),
                filter: DigitalFilter::WEAKEST,
                ..Settings::array()
            };
            let Err(Refusal::ForbiddenFilter { permitted, .. }) = settings.check() else { unreachable!() };
            settings.filter = DigitalFilter::new(permitted).unwrap();
            assert!(settings.check().is_ok());
            settings.filter = DigitalFilter::new(permitted - 1).unwrap();
            assert!(settings.check().is_err());
        }
    }

    #[test]
    fn temperature_compensation_needs_a_fine_resolution_of_the_selected_axes() {
        let mut settings = Settings { temperature_compensation: true, ..Settings::array() };
        settings.resolution.x = Resolution::R3;
        assert!(settings.check().is_ok(), "X is not converted");
        settings.resolution.y = Resolution::R2;
        assert_eq!(settings.check(), Err(Refusal::CompensationResolution { axis: Axis::Y }));
        settings.resolution = Resolutions::all(Resolution::R1);
        assert!(settings.check().is_ok());
    }

    #[test]
    fn a_trigger_needs_an_input() {
        let settings = Settings { external_trigger: true, ..Settings::array() };
        assert!(settings.check().is_ok());
        let output = Settings { trigger_pin: TriggerPin::DataReady, ..settings };
        assert_eq!(output.check(), Err(Refusal::TriggerPinIsOutput));
        assert!(Settings { external_trigger: false, ..output }.check().is_ok());
    }

    #[test]
    fn something_must_be_converted() {
        assert_eq!(Settings { axes: Axes::from_nibble(0), ..Settings::array() }.check(), Err(Refusal::NoAxis));
    }

    #[test]
    fn the_arrays_guarantee_300_hz_and_a_pause_never_does() {
        for settings in [Settings::array(), Settings::array_xyz()] {
            assert_eq!(settings.check().unwrap().check_rate(300.0), Ok(()));
            let paused = Settings { burst_interval: BurstInterval::new(1).unwrap(), ..settings }.check().unwrap();
            assert!(matches!(paused.check_rate(50.0), Err(Refusal::TooSlow { .. })));
        }
    }

    #[test]
    fn a_rate_is_a_positive_number() {
        let settings = Settings::array().check().unwrap();
        for hz in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(settings.check_rate(hz), Err(Refusal::InvalidRate { .. })));
        }
    }
}
