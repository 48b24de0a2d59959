//! Questions about a function along a line, answered by halving the line where the answer is open.
//!
//! The function never changes faster than its argument (it is Lipschitz with constant 1), as the distance from a set does
//! along a curve travelled at unit speed. So its value in the middle of a stretch bounds it on the whole stretch, and only
//! where the bound does not decide is a stretch halved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
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

/// The maximum of `function`, of the index of a line and the place along it, over lines of these `lengths`; or `floor` if that is
/// more.
///
/// The answer is too small by at most `tolerance`. The stretch with the greatest bound is halved first, so that nothing is looked at
/// that could not hold the maximum; a high floor makes it quicker still.
pub(super) fn maximum(
    lengths: impl IntoIterator<Item = f64>,
    floor: f64,
    tolerance: f64,
    function: impl Fn(usize, f64) -> f64,
) -> f64 {
    let whole = |(line, width)| Stretch { bound: f64::INFINITY, line, start: 0.0, width };
    let mut open: BinaryHeap<Stretch> = lengths.into_iter().enumerate().map(whole).collect();
    let mut greatest = floor;
    while let Some(Stretch { line, start, width, .. }) = open.pop().filter(|next| next.bound > greatest + tolerance) {
        let half = 0.5 * width;
        let value = function(line, start + half);
        greatest = greatest.max(value);
        let bound = value + half;
        if bound > greatest + tolerance {
            open.extend([start, start + half].map(|start| Stretch { bound, line, start, width: half }));
        }
    }
    greatest
}

/// A stretch of a line, and a bound of the function there. The greatest bound is the greatest stretch.
struct Stretch {
    bound: f64,
    line: usize,
    start: f64,
    width: f64,
}

impl Ord for Stretch {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

impl PartialOrd for Stretch {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Stretch {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Stretch {}

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
            let greatest = maximum([0.5 * length, length], 0.0, resolution, |_, s| saw(s));
            prop_assert!(greatest <= 0.5 * period + 1e-12 && greatest >= 0.5 * period - resolution);
        }
    }

    #[test]
    fn the_floor_is_the_least_answer() {
        assert!((maximum([1.0], 3.0, 1e-3, |_, s| s) - 3.0).abs() < f64::EPSILON);
    }

    #[test]
    fn a_function_that_is_no_number_ends_all_the_same() {
        assert_eq!(stretches_below(1.0, 0.1, 1e-3, |_| f64::NAN), []);
        assert!(maximum([1.0], 0.0, 1e-3, |_, _| f64::INFINITY).is_infinite());
        assert!(maximum([1.0], 0.0, 1e-3, |_, _| f64::NAN) <= 0.0);
    }
}
