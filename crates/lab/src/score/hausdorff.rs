//! The Hausdorff distance between the reference and the estimate.

use super::Estimate;
use super::lipschitz::maximum;
use vibrissa_world::geometry::{Contour, ContourSet, Point2, Vector2};

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
    let floor = maximum(contours.iter().map(|contour| contour.length()), floor, HAUSDORFF_TOLERANCE, |contour, s| {
        estimate.distance(contours[contour].point_at(s)).unwrap_or(f64::INFINITY)
    });
    let lines = strokes.iter().zip(&at_tips).flat_map(|(stroke, at_tips)| stroke.windows(2).zip(at_tips.windows(2)));
    // The distances at both ends bound the distance in between.
    let bound = |ends: &[Point2], at_ends: &[f64]| 0.5 * (at_ends[0] + at_ends[1] + (ends[1] - ends[0]).norm());
    let lines: Vec<(Point2, Vector2)> = lines
        .filter(|(ends, at_ends)| bound(ends, at_ends) > floor + HAUSDORFF_TOLERANCE)
        .map(|(ends, _)| (ends[0], ends[1] - ends[0]))
        .collect();
    Some(maximum(lines.iter().map(|(_, along)| along.norm()), floor, HAUSDORFF_TOLERANCE, |line, s| {
        let (from, along) = lines[line];
        let length = along.norm();
        let share = if length > 0.0 { s / length } else { 0.0 };
        distance(from + share * along)
    }))
}
