//! The Hausdorff distance between the reference and the estimate.

use super::Estimate;
use super::lipschitz::{Foot, ROUNDING, Sample, maximum};
use vibrissa_world::geometry::{Contour, ContourSet, Nearest, Point2};

/// The largest error (m) of the Hausdorff distance, which is never too large.
pub const HAUSDORFF_TOLERANCE: f64 = 1e-5;

/// The symmetric Hausdorff distance (m) between the strokes of the estimate and the reference. `None` without an
/// estimate.
///
/// The value is too small by at most [`HAUSDORFF_TOLERANCE`].
#[must_use]
pub fn hausdorff(estimate: &Estimate, reference: &ContourSet) -> Option<f64> {
    let distance = |point| reference.distance(point);
    let strokes = estimate.strokes();
    let at_tips: Vec<Vec<f64>> = strokes.iter().map(|stroke| stroke.iter().copied().map(distance).collect()).collect();
    let floor = at_tips.iter().flatten().copied().reduce(f64::max)?;
    // Untraced parts of the reference are usually farthest away. With them first, few lines of the estimate remain to
    // be checked.
    let contours: Vec<&Contour> = reference.contours().collect();
    let floor = of_contours(&decisive(&contours, estimate), floor, estimate);
    let lines = strokes.iter().zip(&at_tips).flat_map(|(stroke, at_tips)| stroke.windows(2).zip(at_tips.windows(2)));
    // The distances at both ends bound the distance in between.
    let bound = |ends: &[Point2], at_ends: &[f64]| 0.5 * (at_ends[0] + at_ends[1] + (ends[1] - ends[0]).norm());
    let lines = lines.filter(|(ends, at_ends)| bound(ends, at_ends) > floor + HAUSDORFF_TOLERANCE);
    Some(lines.fold(floor, |floor, (ends, _)| {
        let (from, along) = (ends[0], ends[1] - ends[0]);
        let length = along.norm();
        let sample = |s: f64| {
            let share = if length > 0.0 { s / length } else { 0.0 };
            let place = from + share * along;
            Sample { place, foot: foot_on(&contours, place) }
        };
        maximum(length, floor, HAUSDORFF_TOLERANCE, sample, |_, _, _| None)
    }))
}

/// The maximum distance (m) of contours from the estimate, or `floor` if that is larger. Each has an upper bound (m) of its
/// distance.
fn of_contours(contours: &[(&Contour, f64)], floor: f64, estimate: &Estimate) -> f64 {
    contours.iter().fold(floor, |floor, &(contour, most)| {
        if most <= floor {
            return floor;
        }
        let sample = |s| {
            let place = contour.point_at(s);
            Sample { place, foot: estimate.foot(place) }
        };
        let along = |foot: &Foot, place, width| estimate.foot_along(foot, place, width);
        maximum(contour.length(), floor, HAUSDORFF_TOLERANCE, sample, along)
    })
}

/// The contours that may decide the distance, in their order, each with an upper bound (m) of the distance on it.
///
/// Among many far objects, each may be farther away than those before it. A contour is left out if the next one that
/// remains begins farther away than its bound: whatever the maximum before both, that on the next one is the same.
fn decisive<'a>(contours: &[&'a Contour], estimate: &Estimate) -> Vec<(&'a Contour, f64)> {
    let mut left: Vec<(&Contour, f64)> = Vec::new();
    let mut next = f64::NEG_INFINITY;
    for &contour in contours.iter().rev() {
        let start = estimate.foot(contour.point_at(0.0)).distance;
        // Half of a closed contour is as far from its start as a place on it can be.
        let reach = if contour.is_closed() { 0.5 } else { 1.0 } * contour.length();
        let most = start + reach + ROUNDING;
        if most > next {
            left.push((contour, most));
            next = start;
        }
    }
    left.reverse();
    left
}

/// The point of several contours that is nearest to a place.
fn foot_on(contours: &[&Contour], place: Point2) -> Foot {
    let mut foot = Foot::nowhere();
    for (curve, contour) in contours.iter().enumerate() {
        // Most contours are too far away for their nearest point to matter.
        if contour.bounding_box().distance(place) < foot.distance {
            let nearest = contour.nearest(place);
            if nearest.distance < foot.distance {
                let Nearest { point, arc_length, distance, .. } = nearest;
                let loop_length = contour.is_closed().then(|| contour.length());
                foot = Foot { distance, place: point, curve, arc_length, loop_length };
            }
        }
    }
    foot
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use proptest::prelude::*;
    use vibrissa_world::geometry::{circle, polygon, unit};

    use super::*;

    proptest! {
        /// Objects in any order, near and far, and an estimate that is off by some millimetres.
        #[test]
        fn contours_that_are_left_out_change_no_bit(
            objects in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64, 0.02..0.2_f64, any::<bool>()), 1..12),
            off in 0.0..5e-3_f64, is_sorted in any::<bool>(),
        ) {
            let mut contours: Vec<Contour> = objects.iter().map(|&(x, y, size, is_round)| {
                let centre = Point2::new(x, y);
                let corners = [0.0, 2.0, 4.0].map(|angle| centre + size * unit(angle));
                if is_round { circle(centre, size).unwrap() } else { polygon(&corners).unwrap() }
            }).collect();
            if is_sorted {
                contours.sort_by(|a, b| a.point_at(0.0).coords.norm().total_cmp(&b.point_at(0.0).coords.norm()));
            }
            let tips = (0..60_u32).map(|k| {
                let distance = 0.1 + off * f64::from(k % 3);
                (k as usize, Point2::from(distance * unit(0.1 * f64::from(k))))
            });
            let estimate = Estimate::of(std::iter::once(tips));
            let contours: Vec<&Contour> = contours.iter().collect();
            let all: Vec<_> = contours.iter().map(|&contour| (contour, f64::INFINITY)).collect();
            for floor in [0.0, 0.5] {
                let expected = of_contours(&all, floor, &estimate);
                let found = of_contours(&decisive(&contours, &estimate), floor, &estimate);
                prop_assert_eq!(found.to_bits(), expected.to_bits());
            }
        }
    }

    #[test]
    fn of_ever_farther_objects_the_last_ones_decide() {
        let contours: Vec<_> = (1..50_u32).map(|k| circle(Point2::new(f64::from(k), 0.0), 0.1).unwrap()).collect();
        let estimate = Estimate::of(std::iter::once([(0, Point2::origin())].into_iter()));
        let contours: Vec<&Contour> = contours.iter().collect();
        assert_eq!(decisive(&contours, &estimate).len(), 1);
    }
}
