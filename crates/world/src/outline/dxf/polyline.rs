//! Polylines, whose sides are segments and arcs.

use vibrissa_runtime::math;

use crate::geometry::{EllipticArc, Piece, Vector2, perpendicular};

use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault, TOLERANCE};
use super::entity::{EntityGeometry, object_transform, unsupported};
use super::record::Record;

/// The largest radius (m) of an arc, because of rounding.
const MAX_RADIUS: f64 = 1e6;

/// A vertex of a polyline: its position, and the bulge of the following side. The bulge is the tangent of a quarter of the side's angle,
/// positive to the left.
type Vertex = ([f64; 2], f64);

/// The geometry of a polyline.
pub(super) fn read(entity: &Record<'_>, transform: &Transform) -> Result<EntityGeometry, OutlineError> {
    let vertices = if entity.kind == "LWPOLYLINE" { own_vertices(entity)? } else { following_vertices(entity)? };
    let transform = object_transform(entity, transform)?;
    let is_closed = entity.integer(70)? & 1 != 0;
    if is_closed && is_flat(&vertices) {
        // A shape without size is no object.
        return Ok(EntityGeometry::Nothing);
    }
    let count = if is_closed { vertices.len() } else { vertices.len().saturating_sub(1) };
    let mut pieces = Vec::with_capacity(count);
    for (&(start, bulge), &(end, _)) in vertices.iter().zip(vertices.iter().cycle().skip(1)).take(count) {
        pieces.extend(side(start, end, bulge, &transform)?);
    }
    Ok(if is_closed { EntityGeometry::Whole(pieces) } else { EntityGeometry::Loose(pieces) })
}

/// True if all sides are straight and on one line.
fn is_flat(vertices: &[Vertex]) -> bool {
    let [(first, _), .., (last, _)] = vertices else { return true };
    let from_first = |place: [f64; 2]| Vector2::new(place[0] - first[0], place[1] - first[1]);
    // The last vertex may be at the first one.
    let farthest = vertices
        .iter()
        .map(|&(place, _)| from_first(place))
        .fold(from_first(*last), |farthest, place| if place.norm() > farthest.norm() { place } else { farthest });
    vertices.iter().all(|&(place, bulge)| bulge == 0.0 && from_first(place).perp(&farthest) == 0.0)
}

/// The vertices of a lightweight polyline, within the entity.
fn own_vertices(entity: &Record<'_>) -> Result<Vec<Vertex>, OutlineError> {
    let mut vertices: Vec<Vertex> = Vec::new();
    for pair in &entity.pairs {
        match (pair.code, vertices.last_mut()) {
            (10, _) => vertices.push(([pair.number()?, 0.0], 0.0)),
            (20, Some((place, _))) => place[1] = pair.number()?,
            (42, Some((_, bulge))) => *bulge = pair.number()?,
            _ => {}
        }
    }
    Ok(vertices)
}

/// The vertices of a polyline in following entities.
fn following_vertices(entity: &Record<'_>) -> Result<Vec<Vertex>, OutlineError> {
    const CLOSED_OR_FITTED_BY_ARCS: i32 = 1 | 2;
    const CONTINUOUS_PATTERN: i32 = 128;
    if entity.integer(70)? & !(CLOSED_OR_FITTED_BY_ARCS | CONTINUOUS_PATTERN) != 0 {
        return Err(
            unsupported("a POLYLINE of splines, in space, or of a mesh", "explode it into lines and arcs").into()
        );
    }
    entity.vertices.iter().map(|vertex| Ok((vertex.place(10)?, vertex.number(42, 0.0)?))).collect()
}

fn side(from: [f64; 2], to: [f64; 2], bulge: f64, transform: &Transform) -> Result<Vec<Piece>, OutlineFault> {
    let (start, end) = (transform.point(from)?, transform.point(to)?);
    if !bulge.is_finite() {
        return Err(OutlineFault::FarOff);
    }
    // The greatest length (m) of the side in any direction of the transform.
    let chord = Vector2::from(to) - Vector2::from(from);
    let length = chord.norm() * transform.x_axis.norm().max(transform.y_axis.norm());
    let (bend, size) = (0.5 * length * bulge.abs(), bulge.abs().max(bulge.abs().recip()));
    if length * size > MAX_RADIUS {
        return if bend <= TOLERANCE { Ok(vec![Piece::segment(start, end)]) } else { Err(OutlineFault::Curve) };
    }
    let sweep = 4.0 * math::atan(bulge);
    if transform.keeps_circles() {
        let hand = transform.x_axis.perp(&transform.y_axis).signum();
        return Ok(vec![Piece::arc_between(start, end, hand * sweep)]);
    }
    if bulge == 0.0 || length == 0.0 {
        return Ok(vec![Piece::segment(start, end)]);
    }
    let centre = Vector2::from(from) + 0.5 * chord + perpendicular(chord) * ((1.0 - bulge * bulge) / (4.0 * bulge));
    let radius = chord.norm() * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    let outward = Vector2::from(from) - centre;
    let arc = EllipticArc {
        centre: (transform.origin + transform.direction(centre.into())).into(),
        radii: [transform.direction([radius, 0.0]), transform.direction([0.0, radius])],
        start_angle: math::atan2(outward.y, outward.x),
        sweep,
    };
    arc.pieces().ok_or(OutlineFault::Curve)
}
