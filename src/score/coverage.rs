//! How much of what there is was traced.

use super::Estimate;
use std::ops::Range;

use super::lipschitz::stretches_below;
use crate::geometry::{Contour, ContourSet, Point2};

/// How near (m) the estimated contour must be for a point of the reference to count as traced.
pub const COVERAGE_TOLERANCE: f64 = 1e-3;

/// Where a traced stretch of the reference ends is known to half of this (m).
pub const COVERAGE_RESOLUTION: f64 = 2e-5;

/// The stretches of a reference contour (arc lengths in m, ascending) that lie within [`COVERAGE_TOLERANCE`] of the
/// estimate; none if there is no estimate. One that goes over the start of a closed contour comes in two parts.
#[must_use]
pub fn traced(estimate: &Estimate, reference: &Contour) -> Vec<Range<f64>> {
    stretches_below(reference.length(), COVERAGE_TOLERANCE, COVERAGE_RESOLUTION, |s| {
        estimate.distance(reference.point_at(s)).unwrap_or(f64::INFINITY)
    })
}

/// The share of the length (0 to 1) of one object's outline that is [traced]: of that on which the last tip of the run lies, which is
/// the one that closed its loop. 0 if there is no tip.
#[must_use]
pub fn object_coverage(estimate: &Estimate, last_tip: Option<Point2>, reference: &ContourSet) -> f64 {
    let Some(tip) = last_tip else { return 0.0 };
    let distance = |contour: &&Contour| contour.nearest(tip).distance;
    let nearest = reference.contours().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or(0.0, |contour| coverage(estimate, &contour.clone().into()))
}

/// The share of the reference's length (0 to 1) that is [traced].
///
/// It counts all of it, whether or not a rig can get there. The share is exact up to half of [`COVERAGE_RESOLUTION`] over the
/// length, for every end of a traced stretch.
#[must_use]
pub fn coverage(estimate: &Estimate, reference: &ContourSet) -> f64 {
    let stretches = reference.contours().flat_map(|contour| traced(estimate, contour));
    // Not `sum`, whose nothing is negative zero.
    let length = stretches.fold(0.0, |sum, stretch| sum + stretch.end - stretch.start);
    (length / reference.length()).min(1.0)
}
