//! Histograms on a logarithmic scale.

use std::iter;

use svg::node::element::Rectangle;
use vibrissa_runtime::math;

use super::scale::{Scale, decade};
use crate::report::style::{self, Anchor, line, px, text};

/// Width and height of the picture (px).
const SIZE: (f64, f64) = (560.0, 240.0);
/// Left, right, upper and lower side of the bars (px).
const SIDES: [f64; 4] = [52.0, 528.0, 40.0, 190.0];
/// Number of bins of a decade.
const BINS: f64 = 10.0;
/// Largest number of decades. Smaller values count in the first bin.
const DECADES: f64 = 5.0;

/// A histogram of positive values on a logarithmic scale: a self-contained SVG. `colour` gives the colour of a bin by its
/// upper end. The values are in the unit that `title` names. Zeros count in the first bin. `None` without a finite value above 0.
pub(in crate::report) fn histogram(
    title: &str,
    values: &[f64],
    colour: impl Fn(f64) -> &'static str,
) -> Option<String> {
    let powers = || {
        values.iter().filter(|value| **value > 0.0).map(|value| math::log10(*value)).filter(|power| power.is_finite())
    };
    let greatest = powers().max_by(f64::total_cmp)?;
    let least = powers().min_by(f64::total_cmp)?;
    let high = (greatest + 0.5 / BINS).ceil();
    let low = least.floor().clamp(high - DECADES, high - 1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most fifty")]
    let count = ((high - low) * BINS).round() as usize;
    let mut bins = vec![0_usize; count];
    for value in values.iter().filter(|value| value.is_finite()) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
        let bin = ((math::log10(value.max(0.0)) - low) * BINS).max(0.0) as usize;
        bins[bin.min(count - 1)] += 1;
    }
    let most = bins.iter().copied().max().unwrap_or(1).max(1);
    let [left, right, top, bottom] = SIDES;
    let x = Scale { values: (low, high), positions: (left, right) };
    let y = Scale { values: (0.0, most as f64), positions: (bottom, top) };
    let mut document =
        style::sheet(SIZE, title).add(text(left, 22.0, Anchor::Start, 14.0, style::INK, title).set("font-weight", 600));
    for (value, label) in y.ticks(4.0).into_iter().filter(|(value, _)| value.fract() == 0.0) {
        let position = y.at(value);
        document = document.add(line((left, position), (right, position), style::GRID, 1.0)).add(text(
            left - 6.0,
            position + 4.0,
            Anchor::End,
            12.0,
            style::GREY,
            &label,
        ));
    }
    for (index, &bin) in bins.iter().enumerate().filter(|(_, bin)| **bin > 0) {
        let [from, to] = [index, index + 1].map(|edge| low + edge as f64 / BINS);
        let height = bottom - y.at(bin as f64);
        let bar = Rectangle::new().set("x", px(x.at(from))).set("y", px(bottom - height)).set("height", px(height));
        document =
            document.add(bar.set("width", px(x.at(to) - x.at(from) - 1.0)).set("fill", colour(math::powf(10.0, to))));
    }
    document = document.add(line((left, bottom), (right, bottom), style::GREY, 1.0));
    for power in iter::successors(Some(low), |power| Some(power + 1.0)).take_while(|power| *power <= high) {
        let position = x.at(power);
        document = document.add(line((position, bottom), (position, bottom + 5.0), style::GREY, 1.0)).add(text(
            position,
            bottom + 20.0,
            Anchor::Middle,
            12.0,
            style::GREY,
            &decade(power),
        ));
    }
    let total = values.len();
    let count = text(right, 22.0, Anchor::End, 12.0, style::GREY, &format!("{total} values"));
    Some(document.add(count).to_string())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    /// The heights of the bars (px).
    fn heights(svg: &str) -> Vec<f64> {
        let bars = svg.split("<rect").filter(|part| part.contains("fill=\"#123456\""));
        let height = |bar: &str| bar.split("height=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        bars.map(height).collect()
    }

    #[test]
    fn the_height_of_a_bar_is_in_proportion_to_its_count_and_no_value_is_lost() {
        let values = [[0.011; 3].as_slice(), &[0.11; 6], &[0.0, 1e-9, 0.99]].concat();
        let svg = histogram("error (mm)", &values, |_| "#123456").unwrap();
        let heights = heights(&svg);
        let unit = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let counts: Vec<f64> = heights.iter().map(|height| (height / unit).round()).collect();
        assert_eq!(counts, [2.0, 3.0, 6.0, 1.0], "{svg}");
    }

    #[test]
    fn values_that_are_all_zero_or_no_numbers_have_no_histogram() {
        for values in [&[][..], &[0.0], &[f64::NAN, f64::INFINITY]] {
            assert_eq!(histogram("error", values, |_| "#123456"), None);
        }
    }
}
