//! The passage of a run through a tunnel.

use crate::run::{PassageWatch, Trace};
use vibrissa_runtime::percept::TipCurve;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_world::geometry::{Contour, ContourSet, Point2, TunnelAxis, rotate};

use super::coverage::COVERAGE_TOLERANCE;
use super::{Estimate, Statistics, Tip};

/// Distance between the sampled points of a wall (m).
const STEP: f64 = 5e-4;

/// The largest distance (m) of a point of a parallel of the axis that is on an inner side. Openings have no inner side.
const ON_SIDE: f64 = 1e-6;

/// The passage of a run through a tunnel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// The [share of the axis](PassageWatch::share) that the platform passed (0 to 1).
    pub share: f64,
    /// The [traced](super::traced) share of the left inner side (0 to 1) between the first and the last contact with
    /// either inner side. 0 without contact.
    pub left_coverage: f64,
    /// The same for the right inner side.
    pub right_coverage: f64,
    /// True if whiskers of the rig reach both walls at once.
    pub reaches_both: bool,
}

impl Passage {
    /// Computes the passage of a run that recorded `tips`. Of several tunnels in `axes`, the one with the longest
    /// passage counts. `reference` contains the inner sides of the walls. `None` without a tunnel.
    pub(super) fn of(
        (trace, tips, estimate): (&Trace, &[Tip], &Estimate),
        axes: &[TunnelAxis],
        reference: &ContourSet,
        rig: &Rig,
    ) -> Option<Self> {
        let shares = axes.iter().map(|axis| (axis, passed_share(trace, axis)));
        let (axis, share) = shares.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let sides = [axis.left(), axis.right()].map(|contour| side_points(contour, axis, reference));
        let reaches_both = whisker_span(rig).is_some_and(|span| is_wider(span, axis, &sides));
        let [left_coverage, right_coverage] = match contact_stretch(tips, axis) {
            None => [0.0; 2],
            Some((first, last)) => sides.map(|points| {
                let within = points.into_iter().filter(|(along, _)| (first..=last).contains(along));
                let traced = within.map(|(_, point)| estimate.is_within(COVERAGE_TOLERANCE, point));
                share_of(traced)
            }),
        };
        Some(Self { share, left_coverage, right_coverage, reaches_both })
    }

    /// The decisive coverage: the smaller of both sides if the whiskers reach both walls at once, else the larger.
    #[must_use]
    pub fn wall_coverage(&self) -> f64 {
        let (left, right) = (self.left_coverage, self.right_coverage);
        if self.reaches_both { left.min(right) } else { left.max(right) }
    }
}

/// The share of `truths` that are true (0 to 1), 0 if there are none.
fn share_of(truths: impl Iterator<Item = bool>) -> f64 {
    let (mut count, mut of) = (0_usize, 0_usize);
    for truth in truths {
        count += usize::from(truth);
        of += 1;
    }
    if of > 0 { count as f64 / of as f64 } else { 0.0 }
}

fn passed_share(trace: &Trace, axis: &TunnelAxis) -> f64 {
    let mut passage = PassageWatch::new(axis);
    for tick in &trace.ticks {
        passage.add(&tick.body);
    }
    passage.share()
}

/// Points of an inner side, with the arc lengths of their projections on the axis's line.
fn side_points(contour: &Contour, axis: &TunnelAxis, reference: &ContourSet) -> Vec<(f64, Point2)> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count that a scene's limits bound")]
    let count = (contour.length() / STEP).ceil() as usize;
    let point = |index: usize| contour.point_at((index as f64 + 0.5) * contour.length() / count as f64);
    let points = (0..count).map(point).filter(|&point| reference.is_within(ON_SIDE, point));
    points.map(|point| (axis.line().nearest_point(point).1, point)).collect()
}

/// The interval along the axis in which tips touch inner sides.
fn contact_stretch(tips: &[Tip], axis: &TunnelAxis) -> Option<(f64, f64)> {
    let on_side =
        |tip: &&Tip| [axis.left(), axis.right()].iter().any(|side| side.is_within(COVERAGE_TOLERANCE, tip.tip_world));
    let along = tips.iter().filter(on_side).map(|tip| axis.line().nearest_point(tip.tip_world).1);
    along.fold(None, |stretch, along| {
        let (first, last) = stretch.unwrap_or((along, along));
        Some((f64::min(first, along), f64::max(last, along)))
    })
}

/// True if `span` (m) exceeds the median distance of points of the inner sides from the opposite side.
fn is_wider(span: f64, axis: &TunnelAxis, [left, right]: &[Vec<(f64, Point2)>; 2]) -> bool {
    let opposite = || {
        let of_left = left.iter().map(|(_, point)| (axis.right(), *point));
        of_left.chain(right.iter().map(|(_, point)| (axis.left(), *point)))
    };
    let count = left.len() + right.len();
    let below = opposite().filter(|(wall, point)| wall.is_within(span.next_down(), *point)).count();
    // Distances decide only if the median is between one below the span and one above it.
    if 2 * below + 2 <= count {
        return false;
    }
    if below < count && 2 * below < count + 2 {
        let widths = Statistics::of(opposite().map(|(wall, point)| wall.distance(point)).collect());
        return widths.is_some_and(|widths| span > widths.percentile(50.0));
    }
    count > 0
}

/// The largest distance (m) of two parallel walls that a left and a right whisker of `rig` touch at once. `None`
/// without two such whiskers.
fn whisker_span(rig: &Rig) -> Option<f64> {
    // A contact is detected above the contact threshold.
    let contact_body = |whisker: &Whisker| {
        let bend = whisker.side() * rig.sensing.contact_threshold;
        let contact = TipCurve::new(whisker).ok()?.contact_base(bend);
        Some(whisker.base_body + rotate(contact, whisker.direction_body))
    };
    let sideways = |side: f64| {
        let whiskers = rig.whiskers.iter().filter(move |whisker| whisker.side() * side > 0.0);
        whiskers.filter_map(contact_body).map(|contact| side * contact.y).max_by(f64::total_cmp)
    };
    Some(sideways(1.0)? + sideways(-1.0)?)
}
