//! Splines.

use crate::geometry::{BSpline, Piece};

use super::super::transform::Transform;
use super::super::{MAX_PIECES, OutlineError, OutlineFault, TOLERANCE};
use super::entity::{EntityGeometry, unsupported};
use super::record::Record;

/// The geometry of a spline, seen from above.
pub(super) fn read(entity: &Record<'_>, transform: &Transform) -> Result<EntityGeometry, OutlineError> {
    let mut places: Vec<[f64; 2]> = Vec::new();
    let (mut knots, mut weights) = (Vec::new(), Vec::new());
    for pair in &entity.pairs {
        match (pair.code, places.last_mut()) {
            (10, _) => places.push([pair.number()?, 0.0]),
            (20, Some(place)) => place[1] = pair.number()?,
            (40, _) => knots.push(pair.number()?),
            (41, _) => weights.push(pair.number()?),
            _ => {}
        }
    }
    if places.is_empty() {
        let advice = "turn it into one with control points, or into a polyline";
        return Err(unsupported("a SPLINE that has only points on it", advice).into());
    }
    if places.len() > MAX_PIECES {
        return Err(OutlineFault::TooLarge { what: "control points", limit: MAX_PIECES }.into());
    }
    let control = places.into_iter().map(|place| transform.point(place)).collect::<Result<Vec<_>, _>>()?;
    let degree = usize::try_from(entity.integer(71)?).unwrap_or_default();
    let (points, knot_count) = (control.len(), knots.len());
    let Some(spline) = BSpline::new(degree, knots, control, weights) else {
        let reason = format!(
            "a SPLINE of degree {degree} with {points} control points and {knot_count} knots is invalid: it needs as many knots as points plus its degree plus 1, in ascending order, and positive weights"
        );
        return Err(OutlineFault::Syntax { reason }.into());
    };
    let pieces = spline.pieces().ok_or(OutlineFault::Curve)?;
    let is_whole = match (pieces.first(), pieces.last()) {
        (Some(first), Some(last)) => (Piece::end(last) - first.start()).norm() <= TOLERANCE,
        _ => true,
    };
    Ok(if is_whole { EntityGeometry::Whole(pieces) } else { EntityGeometry::Loose(pieces) })
}
