//! Questions about a function along a line, answered by halving the line where the answer is open.
//!
//! The function never changes faster than its argument (it is Lipschitz with constant 1), as the distance from a set does
//! along a curve travelled at unit speed. So its value in the middle of a stretch bounds it on the whole stretch, and only
//! where the bound does not decide is a stretch halved.

use std::ops::Range;

/// The stretches of `0..length` where `function` is at most `bound`, in ascending order and apart from each other.
///
/// Their total length is wrong by at most half a `resolution` for every place where the function crosses the bound.
pub(super) fn stretches_below(
    length: f64,
    bound: f64,
    resolution: f64,
    function: impl Fn(f64) -> f64,
) -> Vec<Range<f64>> {
    let mut below: Vec<Range<f64>> = Vec::new();
    let mut open = vec![(0.0, length)];
    while let Some((start, width)) = open.pop() {
        let half = 0.5 * width;
        let value = function(start + half);
        if value + half <= bound || (width <= resolution && value <= bound) {
            match below.last_mut() {
                // What is halved exactly still has its ends rounded.
                Some(last) if start - last.end < 1e-3 * resolution => last.end = start + width,
                _ => below.push(start..start + width),
            }
        } else if value - half <= bound && width > resolution {
            open.extend([(start + half, half), (start, half)]);
        }
    }
    below
}

/// The maximum of `function` on `0..length`, or `floor` if that is more.
///
/// The answer is too small by at most `tolerance`. A high floor makes it quick.
pub(super) fn maximum(length: f64, floor: f64, tolerance: f64, function: impl Fn(f64) -> f64) -> f64 {
    let mut greatest = floor;
    let mut open = vec![(0.0, length)];
    while let Some((start, width)) = open.pop() {
        let half = 0.5 * width;
        let value = function(start + half);
        greatest = greatest.max(value);
        if value + half > greatest + tolerance {
            open.extend([(start, half), (start + half, half)]);
        }
    }
    greatest
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn total(stretches: &[Range<f64>]) -> f64 {
        stretches.iter().map(|stretch| stretch.end - stretch.start).sum()
    }

    proptest! {
        /// Against a saw-tooth, the distance from evenly spaced points, of which everything is known.
        #[test]
        fn a_saw_tooth_is_measured_within_the_bounds(
            teeth in 1..20_u32, period in 0.01..1.0_f64, share in 0.05..0.95_f64, resolution in 1e-5..1e-3_f64,
        ) {
            let length = f64::from(teeth) * period;
            let saw = |s: f64| { let along = s.rem_euclid(period); along.min(period - along) };
            let below = stretches_below(length, 0.5 * share * period, resolution, saw);
            prop_assert!((total(&below) - share * length).abs() <= f64::from(teeth) * resolution + 1e-12);
            prop_assert!(below.windows(2).all(|pair| pair[0].end < pair[1].start));
            let greatest = maximum(length, 0.0, resolution, saw);
            prop_assert!(greatest <= 0.5 * period + 1e-12 && greatest >= 0.5 * period - resolution);
        }
    }

    #[test]
    fn the_floor_is_the_least_answer() {
        assert!((maximum(1.0, 3.0, 1e-3, |s| s) - 3.0).abs() < f64::EPSILON);
    }

    #[test]
    fn a_function_that_is_no_number_ends_all_the_same() {
        assert_eq!(stretches_below(1.0, 0.1, 1e-3, |_| f64::NAN), []);
        assert!(maximum(1.0, 0.0, 1e-3, |_| f64::INFINITY).is_infinite());
        assert!(maximum(1.0, 0.0, 1e-3, |_| f64::NAN) <= 0.0);
    }
}
