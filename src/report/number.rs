//! Numbers in tables.

use super::table::NONE;
use crate::results::Rate;

/// A length in mm with a useful number of decimals, at most three.
pub(crate) fn millimetres(value: f64) -> String {
    format!("{value:.*}", decimals(value))
}

/// A mean and a standard deviation in mm, with the decimals of the mean. The mean alone without a deviation.
pub(crate) fn mean_std(mean: f64, std: Option<f64>) -> String {
    let decimals = decimals(mean);
    let mean = format!("{mean:.decimals$}");
    std.map_or_else(|| mean.clone(), |std| format!("{mean} ± {std:.decimals$}"))
}

/// What a cell of [`rate`] shows, for the caption of its table.
pub(crate) const RATES: &str = "Rates in %, with their 95 % intervals after Wilson";

/// A rate in % with its 95 % interval.
pub(crate) fn rate(rate: Option<Rate>) -> String {
    rate.map_or_else(
        || NONE.to_owned(),
        |Rate { share, interval }| {
            let [share, low, high] = [share, interval[0], interval[1]].map(|part| 100.0 * part);
            format!("{share:.1} ({low:.1}–{high:.1})")
        },
    )
}

fn decimals(millimetres: f64) -> usize {
    match millimetres.abs() {
        size if size < 0.1 => 3,
        size if size < 10.0 => 2,
        size if size < 100.0 => 1,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smaller_the_length_the_more_decimals() {
        assert_eq!([0.0123, 0.123, 1.234, 12.34, 123.4].map(millimetres), ["0.012", "0.12", "1.23", "12.3", "123"]);
        assert_eq!(mean_std(0.8, Some(0.05)), "0.80 ± 0.05");
        assert_eq!(mean_std(0.0412, None), "0.041");
    }

    #[test]
    fn a_rate_stands_beside_its_interval() {
        assert_eq!(rate(Rate::new(176, 200)), "88.0 (82.8–91.8)");
        assert_eq!(rate(Rate::new(3, 3)), "100.0 (43.9–100.0)");
        assert_eq!(rate(Rate::new(0, 0)), NONE);
    }
}
