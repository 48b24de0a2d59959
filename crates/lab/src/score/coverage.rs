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
    stretches_below(reference.length(), COVERAGE_TOLERANCE, COVERAGE_RESOLUTION, |s, range| {
        estimate.distance_between(range, reference.point_at(s))
    })
}

/// The [traced] intervals of each contour of a reference, in its order.
pub(super) fn traced_outlines(estimate: &Estimate, reference: &ContourSet) -> Vec<Vec<Range<f64>>> {
    reference.contours().map(|contour| traced(estimate, contour)).collect()
}

/// The traced share (0 to 1) of each contour of the reference, in its order.
#[must_use]
pub fn outline_coverages(estimate: &Estimate, reference: &ContourSet) -> Vec<f64> {
    outline_shares(&traced_outlines(estimate, reference), reference)
}

/// The share (0 to 1) of each contour of the reference that has been `traced`, in its order.
pub(super) fn outline_shares(traced: &[Vec<Range<f64>>], reference: &ContourSet) -> Vec<f64> {
    let share = |(contour, traced): (&Contour, &Vec<Range<f64>>)| share(traced.iter(), contour.length());
    reference.contours().zip(traced).map(share).collect()
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
    coverage_of(&traced_outlines(estimate, reference), reference)
}

/// The [coverage] by the traced intervals of each contour.
pub(super) fn coverage_of(traced: &[Vec<Range<f64>>], reference: &ContourSet) -> f64 {
    share(traced.iter().flatten(), reference.length())
}

/// The share of `whole` (m) that disjoint intervals cover.
fn share<'t>(stretches: impl Iterator<Item = &'t Range<f64>>, whole: f64) -> f64 {
    // An empty `sum` is negative zero.
    let length = stretches.fold(0.0, |sum, stretch| sum + stretch.end - stretch.start);
    (length / whole).min(1.0)
}
