//! The Hausdorff distance between the reference and the estimate.

use super::Estimate;
use super::lipschitz::{Foot, Sample, maximum};
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
    let floor = reference.contours().fold(floor, |floor, contour| {
        let sample = |s| {
            let place = contour.point_at(s);
            Sample { place, foot: estimate.foot(place) }
        };
        let along = |foot: &Foot, place, width| estimate.foot_along(foot, place, width);
        maximum(contour.length(), floor, HAUSDORFF_TOLERANCE, sample, along)
    });
    let contours: Vec<&Contour> = reference.contours().collect();
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
