//! Formatting of quantities.

use super::{Dimension, parse_unit, units_of};
use crate::math;

/// Formats a value in SI units with a unit that is easy to read, to six significant digits: 0.05 m as `50 mm`.
///
/// ```
/// use vibrissa_runtime::units::{Dimension, format_si};
/// assert_eq!(format_si(0.05, Dimension::LENGTH), "50 mm");
/// assert_eq!(format_si(std::f64::consts::FRAC_PI_2, Dimension::ANGLE), "90 deg");
/// assert_eq!(format_si(0.25, Dimension::NUMBER), "0.25");
/// ```
#[must_use]
pub fn format_si(value_si: f64, dimension: Dimension) -> String {
    if dimension == Dimension::NUMBER {
        return digits(value_si);
    }
    let readings = units_of(dimension).into_iter().filter_map(|name| {
        let value = parse_unit(&name).ok()?.from_si(value_si);
        Some((name, value))
    });
    // The first unit with a number between 1 and 1000 is used, or else the unit with the nearest one.
    let badness = |value: f64| match value.abs() {
        size if size == 0.0 || (1.0..1000.0).contains(&size) => 0.0,
        size => (math::log10(size) - 1.5).abs(),
    };
    readings.min_by(|a, b| badness(a.1).total_cmp(&badness(b.1))).map_or_else(
        || format!("{} {}", digits(value_si), dimension.si_unit()),
        |(name, value)| format!("{} {name}", digits(value)),
    )
}

/// Formats a number to six significant digits, without trailing zeros.
fn digits(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_suits_the_size() {
        assert_eq!(format_si(1.25e-4, Dimension::LENGTH), "125 um");
        assert_eq!(format_si(2.5, Dimension::LENGTH), "2.5 m");
        assert_eq!(format_si(3e-4, Dimension::ANGLE), "300 urad");
        assert_eq!(format_si(1e11, Dimension::PRESSURE), "100 GPa");
        assert_eq!(format_si(0.0, Dimension::TIME), "0 s");
        assert_eq!(format_si(-0.1, Dimension::SPEED), "-100 mm/s");
        assert_eq!(format_si(1.0, Dimension::TORSION_STIFFNESS), "1 N m/rad");
    }

    #[test]
    fn rounding_noise_is_not_shown() {
        assert_eq!(format_si(0.1 + 0.2, Dimension::NUMBER), "0.3");
    }
}
