//! Sensitivity of the axes.

use crate::axes::Axis;
use crate::checked_settings::CheckedSettings;
use crate::settings::Hall;

/// Field per count of X and Y, then of Z (µT), with `HALLCONF` 0xC at 25 °C. Rows are `GAIN_SEL`, columns are RES.
///
/// For `GAIN_SEL` 1, RES 3, the data sheet prints 4.840, which is the value of Z with RES 2 in the row above. All other
/// values double with RES, so this cell has 8 times its first column.
#[rustfmt::skip]
const FIELD_PER_COUNT: [[[f32; 4]; 2]; 8] = [
    [[0.751, 1.502, 3.004, 6.009], [1.210, 2.420, 4.840, 9.680]],
    [[0.601, 1.202, 2.403, 4.807], [0.968, 1.936, 3.872, 7.744]],
    [[0.451, 0.901, 1.803, 3.605], [0.726, 1.452, 2.904, 5.808]],
    [[0.376, 0.751, 1.502, 3.004], [0.605, 1.210, 2.420, 4.840]],
    [[0.300, 0.601, 1.202, 2.403], [0.484, 0.968, 1.936, 3.872]],
    [[0.250, 0.501, 1.001, 2.003], [0.403, 0.807, 1.613, 3.227]],
    [[0.200, 0.401, 0.801, 1.602], [0.323, 0.645, 1.291, 2.581]],
    [[0.150, 0.300, 0.601, 1.202], [0.242, 0.484, 0.968, 1.936]],
];

impl CheckedSettings {
    /// Field per count of an axis (µT). The data sheet's tolerance over temperature is ±3 %.
    #[must_use]
    pub fn field_per_count_microtesla(&self, axis: Axis) -> f32 {
        let settings = self.get();
        let cell = (|| {
            let [xy, z] = FIELD_PER_COUNT.get(usize::from(settings.gain.get()))?;
            let row = if axis == Axis::Z { z } else { xy };
            row.get(usize::from(settings.resolution.of(axis).code()))
        })();
        // Codes are bounded by their types, so the table has the cell.
        let four_phase = cell.copied().unwrap_or(f32::NAN);
        match settings.hall {
            Hall::FourPhase => four_phase,
            Hall::TwoPhase => four_phase * 98.0 / 75.0,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::{Gain, Resolution, Resolutions, Settings};

    /// Ratios of the gains to the most sensitive one.
    const GAIN_RATIOS: [f32; 8] = [5.0, 4.0, 3.0, 2.5, 2.0, 5.0 / 3.0, 4.0 / 3.0, 1.0];

    #[test]
    fn the_table_is_one_product_of_gain_and_resolution_within_its_rounding() {
        for (gain, ratio) in (0..).zip(GAIN_RATIOS) {
            for resolution in [Resolution::R0, Resolution::R1, Resolution::R2, Resolution::R3] {
                let settings = Settings {
                    gain: Gain::new(gain).unwrap(),
                    resolution: Resolutions::all(resolution),
                    ..Settings::array()
                };
                let factor = ratio * f32::from(1_u8 << resolution.code());
                for (axis, base) in [(Axis::X, 0.150_215), (Axis::Y, 0.150_215), (Axis::Z, 0.242)] {
                    let field = settings.check().unwrap().field_per_count_microtesla(axis);
                    assert!((field - base * factor).abs() < 0.000_51, "gain {gain}, {resolution:?}, {axis:?}: {field}");
                }
            }
        }
    }

    #[test]
    fn two_phase_plates_are_less_sensitive() {
        let settings = Settings { hall: Hall::TwoPhase, ..Settings::array() }.check().unwrap();
        assert!((settings.field_per_count_microtesla(Axis::Y) - 0.196).abs() < 1e-6);
    }
}
