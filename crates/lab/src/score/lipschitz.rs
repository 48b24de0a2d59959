//! Queries of a function along a line by bisection.
//!
//! The function has the Lipschitz constant 1, for example the distance from a set along a curve of unit speed. Its
//! value in the middle of an interval therefore bounds it on the whole interval. Only intervals for which the bound is
//! not decisive are bisected.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

/// The disjoint ascending intervals of `0..length` in which `function` is at most `bound`.
///
/// The error of their total length is at most half a `resolution` per crossing of the bound.
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
                // Bisection is exact, but the ends of intervals are rounded.
                Some(last) if start - last.end < 1e-3 * resolution => last.end = start + width,
                _ => below.push(start..start + width),
            }
        } else if value - half <= bound && width > resolution {
            open.extend([(start + half, half), (start, half)]);
        }
    }
    below
}

/// The maximum of `function` over lines of these `lengths`, or `floor` if that is larger. The arguments of the function
/// are the index of a line and the position on it.
///
/// The result is too small by at most `tolerance`. The interval with the largest bound is bisected first, so that only
/// intervals that may contain the maximum are evaluated. A high floor reduces the work further.
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

/// An interval of a line with an upper bound of the function, ordered by this bound.
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
        /// The function is a sawtooth: the distance from equidistant points, for which all results are known.
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
