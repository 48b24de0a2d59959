//! The greatest distance between what there is and its estimate.

use super::Estimate;
use super::lipschitz::maximum;
use crate::geometry::ContourSet;

/// How much too small (m) the Hausdorff distance may come out.
pub const HAUSDORFF_TOLERANCE: f64 = 1e-5;

/// The symmetric Hausdorff distance (m) between the strokes of the estimate and the reference: how far from the
/// other one can get on either. `None` if there is no estimate.
///
/// It is too small by at most [`HAUSDORFF_TOLERANCE`].
#[must_use]
pub fn hausdorff(estimate: &Estimate, reference: &ContourSet) -> Option<f64> {
    let tips = estimate.strokes().iter().flatten();
    let at_tips = tips.map(|&tip| reference.nearest(tip).distance).reduce(f64::max)?;
    let from_estimate = estimate.lines().fold(at_tips, |floor, (from, to)| {
        let (along, length) = (to - from, (to - from).norm());
        maximum(length, floor, HAUSDORFF_TOLERANCE, |s| {
            let share = if length > 0.0 { s / length } else { 0.0 };
            reference.nearest(from + share * along).distance
        })
    });
    Some(reference.contours().fold(from_estimate, |floor, contour| {
        maximum(contour.length(), floor, HAUSDORFF_TOLERANCE, |s| {
            estimate.distance(contour.point_at(s)).unwrap_or(f64::INFINITY)
        })
    }))
}
