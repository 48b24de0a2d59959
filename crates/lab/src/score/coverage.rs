//! Coverage: the traced share of the reference.

use super::Estimate;
use std::ops::Range;

use super::lipschitz::stretches_below;
use vibrissa_world::geometry::{Contour, ContourSet, Point2};

/// The largest distance (m) of a traced point of the reference from the estimated contour.
pub const COVERAGE_TOLERANCE: f64 = 1e-3;

/// The resolution (m) of the ends of a traced interval. Their error is at most half of it.
pub const COVERAGE_RESOLUTION: f64 = 2e-5;

/// The intervals of a reference contour within [`COVERAGE_TOLERANCE`] of the estimate, as ascending arc lengths (m).
/// Empty without an estimate. An interval across the start of a closed contour has two parts.
#[must_use]
pub fn traced(estimate: &Estimate, reference: &Contour) -> Vec<Range<f64>> {
    stretches_below(reference.length(), COVERAGE_TOLERANCE, COVERAGE_RESOLUTION, |s| {
        estimate.distance(reference.point_at(s)).unwrap_or(f64::INFINITY)
    })
}

/// The traced share (0 to 1) of each contour of the reference, in its order.
#[must_use]
pub fn outline_coverages(estimate: &Estimate, reference: &ContourSet) -> Vec<f64> {
    reference.contours().map(|contour| coverage(estimate, &contour.clone().into())).collect()
}

/// The [traced share](outline_coverages) of the outline that the last tip of the run belongs to. Its loop is the one that
/// closed. 0 without tips.
#[must_use]
pub fn object_coverage(outlines: &[f64], last_tip: Option<Point2>, reference: &ContourSet) -> f64 {
    let Some(tip) = last_tip else { return 0.0 };
    let distances = reference.contours().map(|contour| contour.nearest(tip).distance);
    let nearest = distances.zip(outlines).min_by(|(a, _), (b, _)| a.total_cmp(b));
    nearest.map_or(0.0, |(_, &coverage)| coverage)
}

/// The [traced] share of the reference's length (0 to 1).
///
/// The whole reference counts, including parts out of reach. The error is at most half of [`COVERAGE_RESOLUTION`] per
/// end of a traced interval, relative to the length.
#[must_use]
pub fn coverage(estimate: &Estimate, reference: &ContourSet) -> f64 {
    let stretches = reference.contours().flat_map(|contour| traced(estimate, contour));
    // An empty `sum` is negative zero.
    let length = stretches.fold(0.0, |sum, stretch| sum + stretch.end - stretch.start);
    (length / reference.length()).min(1.0)
}
