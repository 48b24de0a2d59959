//! The geometry of entities.

use std::f64::consts::TAU;

use crate::geometry::{EllipticArc, Piece, Vector2, perpendicular};

use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault, TOLERANCE};
use super::record::Record;

/// The largest radius (m) of an arc, because of rounding.
const MAX_RADIUS: f64 = 1e6;

/// Entities that are not outlines: texts, dimensions, hatches, points, images, views, construction aids, and the end of
/// a polyline's vertex list.
const ANNOTATIONS: [&str; 31] = [
    "TEXT",
    "MTEXT",
    "RTEXT",
    "ARCALIGNEDTEXT",
    "ATTRIB",
    "ATTDEF",
    "ACAD_TABLE",
    "DIMENSION",
    "ARC_DIMENSION",
    "LARGE_RADIAL_DIMENSION",
    "LEADER",
    "MLEADER",
    "MULTILEADER",
    "TOLERANCE",
    "HATCH",
    "POINT",
    "IMAGE",
    "WIPEOUT",
    "OLEFRAME",
    "OLE2FRAME",
    "PDFUNDERLAY",
    "DWFUNDERLAY",
    "DGNUNDERLAY",
    "UNDERLAY",
    "VIEWPORT",
    "XLINE",
    "RAY",
    "LIGHT",
    "SUN",
    "CAMERA",
    "SEQEND",
];

/// The geometry of an entity.
pub(super) enum EntityGeometry {
    Nothing,
    /// A complete outline.
    Whole(Vec<Piece>),
    /// A part of an outline.
    Loose(Vec<Piece>),
}

/// A vertex of a polyline: its position, and the bulge of the following side.
type Vertex = ([f64; 2], f64);

pub(super) fn geometry(entity: &Record<'_>, transform: &Transform) -> Result<EntityGeometry, OutlineError> {
    let drawn = match entity.kind {
        "LINE" => {
            let end = |code| -> Result<_, OutlineError> { Ok(transform.point(entity.place(code)?)?) };
            return Ok(EntityGeometry::Loose(vec![Piece::segment(end(10)?, end(11)?)]));
        }
        "CIRCLE" | "ARC" => {
            let radius = entity.number(40, 0.0)?;
            if radius <= 0.0 {
                return Err(OutlineFault::Radius { radius }.into());
            }
            let angles = match entity.kind {
                "ARC" => [entity.number(50, 0.0)?, entity.number(51, 360.0)?].map(f64::to_radians),
                _ => [0.0, TAU],
            };
            let radii = [Vector2::new(radius, 0.0), Vector2::new(0.0, radius)];
            elliptic(&object_transform(entity, transform)?, entity.place(10)?, radii, angles)
        }
        "ELLIPSE" => {
            let ratio = entity.number(40, 1.0)?;
            if ratio <= 0.0 {
                return Err(OutlineFault::AxisRatio { ratio }.into());
            }
            // The centre and the axis are in world coordinates, regardless of the direction of view.
            let hand = object_transform(entity, transform)?.x_axis.dot(&transform.x_axis).signum();
            let major = Vector2::from(entity.place(11)?);
            let minor = perpendicular(major) * (hand * ratio);
            let angles = [entity.number(41, 0.0)?, entity.number(42, TAU)?];
            elliptic(transform, entity.place(10)?, [major, minor], angles)
        }
        "LWPOLYLINE" => {
            polyline(&lightweight_vertices(entity)?, entity.integer(70)?, &object_transform(entity, transform)?)
        }
        "POLYLINE" => {
            polyline(&following_vertices(entity)?, entity.integer(70)?, &object_transform(entity, transform)?)
        }
        "SPLINE" => Err(unsupported("SPLINE", "turn it into a polyline with arcs, or save the drawing as SVG")),
        "INSERT" => Err(unsupported("INSERT", "explode the block")),
        kind if ANNOTATIONS.contains(&kind) => Ok(EntityGeometry::Nothing),
        kind => {
            let kind: String = kind.chars().filter(|letter| !letter.is_control()).take(40).collect();
            Err(unsupported(&kind, "explode it into lines and arcs, or take it out"))
        }
    };
    Ok(drawn?)
}

/// The transform of an entity's own coordinates. The x axis of an entity that is seen from below is reversed.
fn object_transform(entity: &Record<'_>, transform: &Transform) -> Result<Transform, OutlineError> {
    let [x, y, z] = [entity.number(210, 0.0)?, entity.number(220, 0.0)?, entity.number(230, 1.0)?];
    let is_level = z != 0.0 && x.abs() + y.abs() <= 1e-9 * z.abs();
    if !is_level {
        return Err(unsupported("an entity that is tilted", "draw it in the x-y transform").into());
    }
    Ok(transform.inner([z.signum(), 0.0], [0.0, 1.0], [0.0, 0.0]))
}

fn elliptic(
    transform: &Transform,
    centre: [f64; 2],
    radii: [Vector2; 2],
    [from, to]: [f64; 2],
) -> Result<EntityGeometry, OutlineFault> {
    for radius in radii {
        transform.point([centre[0] + radius.x, centre[1] + radius.y])?;
    }
    let turn = (to - from).rem_euclid(TAU);
    if !from.is_finite() || !turn.is_finite() {
        return Err(OutlineFault::FarOff);
    }
    // An arc with equal angles is a full turn.
    let is_whole = turn <= 1e-9 || TAU - turn <= 1e-9;
    let sweep = if is_whole { TAU } else { turn };
    let radii = radii.map(|radius| transform.direction(radius.into()));
    let arc = EllipticArc { centre: transform.point(centre)?, radii, start_angle: from, sweep };
    let pieces = arc.pieces().ok_or(OutlineFault::Curve)?;
    Ok(if is_whole { EntityGeometry::Whole(pieces) } else { EntityGeometry::Loose(pieces) })
}

/// The vertices of a lightweight polyline, within the entity.
fn lightweight_vertices(entity: &Record<'_>) -> Result<Vec<Vertex>, OutlineError> {
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

/// A polyline with arcs as sides. The bulge is the tangent of a quarter of the angle, positive to the left.
fn polyline(vertices: &[Vertex], flags: i32, transform: &Transform) -> Result<EntityGeometry, OutlineFault> {
    let hand = transform.x_axis.perp(&transform.y_axis).signum();
    let is_closed = flags & 1 != 0;
    let count = if is_closed { vertices.len() } else { vertices.len().saturating_sub(1) };
    let mut pieces = Vec::with_capacity(count);
    for (&(start, bulge), &(end, _)) in vertices.iter().zip(vertices.iter().cycle().skip(1)).take(count) {
        let (start, end) = (transform.point(start)?, transform.point(end)?);
        if !bulge.is_finite() {
            return Err(OutlineFault::FarOff);
        }
        let length = (end - start).norm();
        let (bend, size) = (0.5 * length * bulge.abs(), bulge.abs().max(bulge.abs().recip()));
        if length * size <= MAX_RADIUS {
            pieces.push(Piece::arc_between(start, end, 4.0 * (hand * bulge).atan()));
        } else if bend <= TOLERANCE {
            pieces.push(Piece::segment(start, end));
        } else {
            return Err(OutlineFault::Curve);
        }
    }
    Ok(if is_closed { EntityGeometry::Whole(pieces) } else { EntityGeometry::Loose(pieces) })
}

fn unsupported(what: &str, advice: &'static str) -> OutlineFault {
    OutlineFault::Unsupported { what: what.to_owned(), advice }
}
