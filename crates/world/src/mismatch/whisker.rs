//! A true whisker.

use super::Property as P;
use super::ranges::Values;
use crate::geometry::Vector2;
use vibrissa_runtime::rig::Whisker;

/// The true whisker that differs by `values` from the `assumed` one.
///
/// A curved shaft whose tip is `d` aside has the curvature `2 d / L²` for the length `L`.
pub(super) fn true_whisker(assumed: &Whisker, values: &Values) -> Whisker {
    let mut whisker = assumed.clone();
    let relative = |property| 1.0 + values.or_zero(property);
    let side = assumed.side();
    values.apply(&mut whisker);
    let shaft = &mut whisker.shaft;
    let tip_radius = shaft.tip_radius.unwrap_or(shaft.radius) * (relative(P::Radius) * relative(P::TipRadius));
    shaft.radius *= relative(P::Radius);
    if shaft.tip_radius.is_some() || values.get(P::TipRadius).is_some() {
        shaft.tip_radius = Some(tip_radius);
    }
    shaft.curvature += side * 2.0 * values.or_zero(P::TipAside) / (shaft.length * shaft.length);
    if let Some(links) = values.get(P::Links) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count that was checked")]
        let links = links.round().max(1.0) as usize;
        shaft.links = links;
    }
    whisker.base_body += Vector2::new(values.or_zero(P::BaseForward), side * values.or_zero(P::BaseOutward));
    whisker.direction_body += side * values.or_zero(P::Direction);
    whisker
}
