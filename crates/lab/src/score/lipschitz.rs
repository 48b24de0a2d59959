//! Queries of a function along a line by bisection.
//!
//! The function has the Lipschitz constant 1, for example the distance from a set along a curve of unit speed. Its
//! value in the middle of an interval therefore bounds it on the whole interval. Only intervals for which the bound is
//! not decisive are bisected.

use std::ops::Range;

use vibrissa_world::geometry::Point2;

/// The disjoint ascending intervals of `0..length` in which `function` is at most `bound`.
///
/// The error of their total length is at most half a `resolution` per crossing of the bound. `function` receives the range in
/// which its value must be exact. A value beyond an end of the range is any number at or beyond that end.
pub(super) fn stretches_below(
    length: f64,
    bound: f64,
    resolution: f64,
    function: impl Fn(f64, Range<f64>) -> f64,
) -> Vec<Range<f64>> {
    let mut below: Vec<Range<f64>> = Vec::new();
    let mut open = vec![(0.0, length)];
    while let Some((start, width)) = open.pop() {
        let half = 0.5 * width;
        let value = function(start + half, bound - half - ROUNDING..bound + half + ROUNDING);
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

/// The rounding error (m) of a sum of lengths.
pub(super) const ROUNDING: f64 = 1e-12;

/// The point of a set of curves that is nearest to a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// Its distance (m) from the place.
    pub(super) distance: f64,
    /// The point (m, world frame).
    pub(super) place: Point2,
    /// The index of its curve.
    pub(super) curve: usize,
    /// Its arc length (m) on this curve.
    pub(super) arc_length: f64,
    /// The length (m) of this curve if it is closed.
    pub(super) loop_length: Option<f64>,
}

impl Foot {
    /// The foot on a set of no curves, at an infinite distance.
    pub(super) fn nowhere() -> Self {
        Self { distance: f64::INFINITY, place: Point2::origin(), curve: usize::MAX, arc_length: 0.0, loop_length: None }
    }

    /// The length (m) of the curve between two feet on it. `None` on different curves.
    fn length_to(&self, other: &Self) -> Option<f64> {
        let apart = (self.arc_length - other.arc_length).abs();
        let around = self.loop_length.map_or(f64::INFINITY, |whole| whole - apart);
        (self.curve == other.curve).then(|| apart.min(around).max(0.0))
    }
}

/// A place on a line and its foot on the curves whose distance is measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub(super) place: Point2,
    pub(super) foot: Foot,
}

/// An interval of a line between two samples, with an upper bound (m) of the distance on it.
#[derive(Clone, Copy)]
struct Stretch {
    start: (f64, Sample),
    end: (f64, Sample),
    bound: f64,
}

/// The maximum distance (m) of the positions of a line of this `length` (m) from a set of curves, or `floor` if that is
/// larger. `sample` returns the position at an arc length of the line, with its foot. `along` may return the foot of a position on the
/// same curve as a given foot, within a distance along this curve.
///
/// The result is too small by at most `tolerance`. Intervals are bisected depth first, the one with the larger bound
/// first. Two bounds hold between samples `a` and `b`, and the smaller one counts:
/// - The distance changes by at most the detour: half of the sum of both distances and the length in between.
/// - If both feet are on one curve, the positions are as near to the chord of the feet as `a` or `b`, except that both
///   curves leave their chords, by at most [`sagitta`]. Where both are almost straight, this bound needs no bisection.
pub(super) fn maximum(
    length: f64,
    floor: f64,
    tolerance: f64,
    sample: impl Fn(f64) -> Sample,
    along: impl Fn(&Foot, Point2, f64) -> Option<Foot>,
) -> f64 {
    let stretch = |start: (f64, Sample), end: (f64, Sample)| {
        let (width, (a, b)) = (end.0 - start.0, (&start.1, &end.1));
        let of_line = sagitta(width, (b.place - a.place).norm());
        let of_feet = |from: &Foot, to: &Foot| {
            let length = from.length_to(to)?;
            Some(from.distance.max(to.distance) + of_line + sagitta(length, (to.place - from.place).norm()))
        };
        let by_way = 0.5 * (a.foot.distance + b.foot.distance + width);
        let bound = of_feet(&a.foot, &b.foot).map_or(by_way, |bound| bound.min(by_way));
        Stretch { start, end, bound }
    };
    // A line that was traced several times has feet on several traces.
    let refined = |open: Stretch| {
        let (width, (a, b)) = (open.end.0 - open.start.0, (&open.start.1, &open.end.1));
        let of_line = sagitta(width, (b.place - a.place).norm());
        let by_trace = [(a, b), (b, a)].into_iter().filter_map(|(from, to)| {
            let foot = along(&from.foot, to.place, REACH_ALONG * width)?;
            let length = from.foot.length_to(&foot)?;
            let chord = (foot.place - from.foot.place).norm();
            Some(from.foot.distance.max(foot.distance) + of_line + sagitta(length, chord))
        });
        by_trace.fold(open.bound, f64::min)
    };
    let (first, last) = (sample(0.0), sample(length));
    let mut greatest = floor.max(first.foot.distance).max(last.foot.distance);
    let mut open = vec![stretch((0.0, first), (length, last))];
    while let Some(next) = open.pop() {
        if !(next.bound > greatest + tolerance && refined(next) > greatest + tolerance) {
            continue;
        }
        let at = 0.5 * (next.start.0 + next.end.0);
        let middle = sample(at);
        greatest = greatest.max(middle.foot.distance);
        let halves = [stretch(next.start, (at, middle)), stretch((at, middle), next.end)];
        let [first, last] = halves;
        open.extend(if first.bound > last.bound { [last, first] } else { [first, last] });
    }
    greatest
}

/// The distance along a curve, in lengths of the interval, within which the foot of its other end is sought.
const REACH_ALONG: f64 = 2.0;

/// The largest distance (m) of a curve of this `length` from its `chord` (m): half of the smaller axis of the ellipse of
/// all points that a curve of this length between the ends can reach.
fn sagitta(length: f64, chord: f64) -> f64 {
    0.5 * (length * length - chord * chord).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use vibrissa_runtime::math;

    use super::*;

    fn total(stretches: &[Range<f64>]) -> f64 {
        stretches.iter().map(|stretch| stretch.end - stretch.start).sum()
    }

    /// A place on a line with its foot on one of points at a distance of a period.
    fn from_points(s: f64, distance: f64, period: f64) -> Sample {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index of a point")]
        let curve = (s / period).round() as usize;
        let place = Point2::new(curve as f64 * period, 0.0);
        Sample { place: Point2::new(s, 0.0), foot: Foot { distance, place, curve, ..Foot::nowhere() } }
    }

    proptest! {
        /// The function is a sawtooth: the distance from equidistant points, for which all results are known.
        #[test]
        fn a_saw_tooth_is_measured_within_the_bounds(
            teeth in 1..20_u32, period in 0.01..1.0_f64, share in 0.05..0.95_f64, resolution in 1e-5..1e-3_f64,
        ) {
            let length = f64::from(teeth) * period;
            let saw = |s: f64| { let along = s.rem_euclid(period); along.min(period - along) };
            let below = stretches_below(length, 0.5 * share * period, resolution, |s, _| saw(s));
            prop_assert!((total(&below) - share * length).abs() <= f64::from(teeth) * resolution + 1e-12);
            prop_assert!(below.windows(2).all(|pair| pair[0].end < pair[1].start));
            let greatest = maximum(length, 0.0, resolution, |s| from_points(s, saw(s), period), |_, _, _| None);
            prop_assert!(greatest <= 0.5 * period + 1e-12 && greatest >= 0.5 * period - resolution);
        }
    }

    #[test]
    fn a_line_along_a_straight_curve_needs_its_ends_alone() {
        let samples = std::cell::Cell::new(0);
        let beside = |s: f64| {
            samples.set(samples.get() + 1);
            let foot = Foot {
                distance: 0.1 + 0.01 * s,
                place: Point2::new(s, 0.0),
                curve: 0,
                arc_length: s,
                loop_length: None,
            };
            Sample { place: Point2::new(s, foot.distance), foot }
        };
        let length = math::hypot(1.0, 0.01);
        let greatest = maximum(length, 0.0, 1e-5, |s| beside(s / length), |_, _, _| None);
        assert!((greatest - 0.11).abs() < 1e-12 && samples.get() == 2, "{greatest} after {} samples", samples.get());
    }

    #[test]
    fn the_floor_is_the_least_answer() {
        assert!((maximum(1.0, 3.0, 1e-3, |s| from_points(s, s, 1.0), |_, _, _| None) - 3.0).abs() < f64::EPSILON);
    }

    #[test]
    fn a_function_that_is_no_number_ends_all_the_same() {
        assert_eq!(stretches_below(1.0, 0.1, 1e-3, |_, _| f64::NAN), []);
        let constant = |distance| maximum(1.0, 0.0, 1e-3, |s| from_points(s, distance, 1.0), |_, _, _| None);
        assert!(constant(f64::INFINITY).is_infinite());
        assert!(constant(f64::NAN) <= 0.0);
    }
}
