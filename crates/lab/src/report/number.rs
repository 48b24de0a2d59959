//! Numbers in tables.

use super::table::known;
use crate::results::Rate;

/// Number of significant digits. A number of fixed decimals would be 0.000 in a simulator without noise.
const DIGITS: usize = 3;

/// A length in mm with three significant digits.
pub(crate) fn millimetres(value: f64) -> String {
    significant(value)
}

/// A mean and a standard deviation in mm. The mean alone without a deviation. The deviation has at most two decimals more than the mean,
/// so that errors of rounding are zero.
pub(crate) fn mean_std(mean: f64, std: Option<f64>) -> String {
    let Some(std) = std else { return significant(mean) };
    let Some(of_mean) = decimals(mean) else { return format!("{} ± {}", significant(mean), significant(std)) };
    let shown = format!("{std:.*}", decimals(std).unwrap_or(of_mean).clamp(of_mean, of_mean + 2));
    let is_zero = shown.bytes().all(|digit| matches!(digit, b'0' | b'.'));
    format!("{} ± {}", significant(mean), if is_zero { format!("{std:.of_mean$}") } else { shown })
}

/// What a cell of [`rate`] shows, for the caption of its table.
pub(crate) const RATES: &str = "Rates in %, with their 95 % intervals after Wilson";

/// A rate in % with its 95 % interval.
pub(crate) fn rate(rate: Option<Rate>) -> String {
    known(rate, |Rate { share, interval }| {
        let [share, low, high] = [share, interval[0], interval[1]].map(|part| 100.0 * part);
        format!("{share:.1} ({low:.1}–{high:.1})")
    })
}

/// A number with three significant digits, and all digits before the point.
pub(crate) fn significant(value: f64) -> String {
    match decimals(value) {
        Some(decimals) => format!("{value:.decimals$}"),
        // Without the sign of a negative zero.
        None if value == 0.0 => "0".to_owned(),
        None if value.is_finite() => format!("{value:.*e}", DIGITS - 1),
        None => value.to_string(),
    }
}

/// The decimals of a number with three significant digits. `None` for zero, and for a number that is written with an exponent.
fn decimals(value: f64) -> Option<usize> {
    /// Numbers below ten to this exponent are written with one.
    const LEAST_EXPONENT: i32 = -6;
    if value == 0.0 || !value.is_finite() {
        return None;
    }
    // The exponent after rounding: 0.9996 has that of 1.
    let scientific = format!("{value:.*e}", DIGITS - 1);
    let exponent: i32 = scientific.split_once('e')?.1.parse().ok()?;
    let after_first = i32::try_from(DIGITS).ok()? - 1;
    (exponent >= LEAST_EXPONENT).then(|| usize::try_from(after_first - exponent).unwrap_or(0))
}

/// A number with its sign, as [`significant`].
pub(crate) fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", significant(value)) } else { significant(value) }
}

#[cfg(test)]
mod tests {
    use super::super::table::NONE;
    use super::*;

    #[test]
    fn a_length_of_any_size_has_three_significant_digits() {
        assert_eq!([0.0123, 0.123, 1.234, 12.34, 123.4].map(millimetres), ["0.0123", "0.123", "1.23", "12.3", "123"]);
        assert_eq!(
            [3.21e-4, 3.216e-6, 3.216e-9, 1234.0].map(millimetres),
            ["0.000321", "0.00000322", "3.22e-9", "1234"]
        );
        assert_eq!([0.9996, 0.0, -0.0, f64::INFINITY].map(millimetres), ["1.00", "0", "0", "inf"]);
        assert_eq!(mean_std(0.8, Some(0.05)), "0.800 ± 0.0500");
        assert_eq!(mean_std(3.1e-4, Some(4.9e-5)), "0.000310 ± 0.0000490");
        assert_eq!([1e-15, 0.003].map(|std| mean_std(0.2, Some(std))), ["0.200 ± 0.000", "0.200 ± 0.00300"]);
        assert_eq!(mean_std(0.2, Some(0.0)), "0.200 ± 0.000");
        assert_eq!(mean_std(0.0412, None), "0.0412");
        assert_eq!([0.5, -0.5, 0.0].map(signed), ["+0.500", "-0.500", "0"]);
    }

    #[test]
    fn a_rate_stands_beside_its_interval() {
        assert_eq!(rate(Rate::new(176, 200)), "88.0 (82.8–91.8)");
        assert_eq!(rate(Rate::new(3, 3)), "100.0 (43.9–100.0)");
        assert_eq!(rate(Rate::new(0, 0)), NONE);
    }
}
