//! The section `sensor`: the settings that all sensors share.

use serde::{Deserialize, Serialize};
use vibrissa_mlx90393::{
    CheckedSettings, DigitalFilter, Gain, OutOfRange, Oversampling, Refusal, Resolution, Resolutions, Settings,
};

use super::whole_number;

/// The settings of the sensors. They are those of the baseline's array by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SensorConfig {
    /// Oversampling ratio, OSR (0 to 3).
    #[serde(deserialize_with = "whole_number::up_to::<3, _>")]
    pub oversampling: u8,
    /// Digital filter, `DIG_FILT` (0 to 7).
    #[serde(deserialize_with = "whole_number::up_to::<7, _>")]
    pub filter: u8,
    /// Gain, `GAIN_SEL` (0 to 7). 7 is the most sensitive.
    #[serde(deserialize_with = "whole_number::up_to::<7, _>")]
    pub gain: u8,
    /// Resolution of the Y axis, `RES_Y` (0 to 3). 0 is the finest.
    #[serde(deserialize_with = "whole_number::up_to::<3, _>")]
    pub resolution: u8,
}

impl Default for SensorConfig {
    fn default() -> Self {
        Self { oversampling: 2, filter: 3, gain: 7, resolution: 0 }
    }
}

/// Settings that no sensor can have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SensorConfigError {
    /// A number is too large.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The sensor does not permit this combination, or it is too slow for the sample rate.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

impl SensorConfig {
    /// The settings, with the Y axis in continuous burst mode, for a sample rate (Hz).
    ///
    /// # Errors
    /// [`SensorConfigError`] if the sensor does not permit them, or if it may be slower than the sample rate.
    pub fn settings(&self, sample_rate: f64) -> Result<CheckedSettings, SensorConfigError> {
        let resolution = [Resolution::R0, Resolution::R1, Resolution::R2, Resolution::R3];
        let resolution = resolution.get(usize::from(self.resolution)).copied().unwrap_or(Resolution::R3);
        let settings = Settings {
            gain: Gain::new(self.gain)?,
            resolution: Resolutions::all(resolution),
            oversampling: Oversampling::new(self.oversampling)?,
            filter: DigitalFilter::new(self.filter)?,
            ..Settings::array()
        };
        let checked = settings.check()?;
        #[expect(clippy::cast_possible_truncation, reason = "a rate of some hundred hertz")]
        checked.check_rate(sample_rate as f32)?;
        Ok(checked)
    }
}
