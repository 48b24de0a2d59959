//! Linear scales with round ticks.

use vibrissa_runtime::math;

/// A linear scale from values to px.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    /// The values at both ends.
    pub(super) values: (f64, f64),
    /// The positions of both ends (px).
    pub(super) positions: (f64, f64),
}

impl Scale {
    /// The position of a value (px).
    pub(super) fn at(&self, value: f64) -> f64 {
        let (low, high) = self.values;
        self.positions.0 + (value - low) / (high - low) * (self.positions.1 - self.positions.0)
    }

    /// About `wanted` round values on the scale, with their texts.
    pub(super) fn ticks(&self, wanted: f64) -> Vec<(f64, String)> {
        let (low, high) = self.values;
        let step = round_step((high - low) / wanted);
        let first = (low / step - 1e-9).ceil();
        // A bound, because steps can be below the resolution of the values.
        (0..100)
            .map(|k| (first + f64::from(k)) * step)
            .take_while(|&value| value <= high + 1e-9 * step)
            .map(|value| (value, label(value, step)))
            .collect()
    }
}

/// The least of 1, 2 and 5 times a power of ten that is at least `least`.
pub(super) fn round_step(least: f64) -> f64 {
    let power = math::powf(10.0, math::log10(least).floor());
    [1.0, 2.0, 5.0].map(|digit| digit * power).into_iter().find(|&step| step >= 0.999 * least).unwrap_or(10.0 * power)
}

/// The text of ten to a whole power. A computed power of ten can end in nines, and the nearest number to a decimal text cannot.
pub(super) fn decade(power: f64) -> String {
    format!("1e{power}").parse().map_or_else(|_| String::new(), |value: f64| value.to_string())
}

/// The text of a multiple of `step`, with the decimals of `step`.
fn label(value: f64, step: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small whole number")]
    let decimals = (-math::log10(step).floor()).clamp(0.0, 12.0) as usize;
    let size = format!("{:.decimals$}", value.abs());
    if value < -0.5 * step { format!("\u{2212}{size}") } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(values: (f64, f64), wanted: f64) -> Vec<String> {
        Scale { values, positions: (0.0, 1.0) }.ticks(wanted).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn decades_have_no_other_digits() {
        assert_eq!([-5.0, -1.0, 0.0, 3.0].map(decade), ["0.00001", "0.1", "1", "1000"]);
    }

    #[test]
    fn ticks_are_round_and_within_the_scale() {
        assert_eq!(ticks((0.0, 1.0), 5.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(ticks((-130.0, 240.0), 4.0), ["\u{2212}100", "0", "100", "200"]);
        assert_eq!(ticks((0.0, 3e-4), 3.0), ["0.0000", "0.0001", "0.0002", "0.0003"]);
    }

    #[test]
    fn the_ends_of_a_scale_come_out_exactly() {
        let scale = Scale { values: (2.0, 4.0), positions: (10.0, -10.0) };
        assert_eq!((scale.at(2.0), scale.at(3.0), scale.at(4.0)), (10.0, 0.0, -10.0));
    }

    #[test]
    fn a_step_is_the_next_round_one() {
        for (least, step) in [(0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (3.0, 5.0), (5.1, 10.0)] {
            assert!((round_step(least) - step).abs() < 1e-12, "{least}");
        }
    }
}
