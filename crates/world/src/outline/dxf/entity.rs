//! The geometry of entities.

use std::f64::consts::TAU;

use crate::geometry::{EllipticArc, Piece, Vector2, perpendicular};

use super::super::text::shown;
use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault};
use super::record::Record;
use super::{polyline, spline};

/// Entities that are not outlines: texts, dimensions, hatches, points, images, views, construction aids, and the end of
/// a polyline's vertex list.
const ANNOTATIONS: &str = "TEXT MTEXT RTEXT ARCALIGNEDTEXT ATTRIB ATTDEF ACAD_TABLE DIMENSION ARC_DIMENSION LARGE_RADIAL_DIMENSION \
    LEADER MLEADER MULTILEADER TOLERANCE HATCH POINT IMAGE WIPEOUT OLEFRAME OLE2FRAME PDFUNDERLAY DWFUNDERLAY \
    DGNUNDERLAY UNDERLAY VIEWPORT XLINE RAY LIGHT SUN CAMERA SEQEND";

/// The geometry of an entity.
pub(super) enum EntityGeometry {
    Nothing,
    /// A complete outline.
    Whole(Vec<Piece>),
    /// A part of an outline.
    Loose(Vec<Piece>),
}

/// True if entities of a kind are not outlines.
pub(super) fn is_annotation(kind: &str) -> bool {
    ANNOTATIONS.split(' ').any(|annotation| annotation == kind)
}

pub(super) fn geometry(entity: &Record<'_>, transform: &Transform) -> Result<EntityGeometry, OutlineError> {
    let drawn = match entity.kind {
        "LINE" => {
            let end = |code| -> Result<_, OutlineError> { Ok(transform.point(entity.place(code)?)?) };
            return Ok(EntityGeometry::Loose(vec![Piece::segment(end(10)?, end(11)?)]));
        }
        "CIRCLE" | "ARC" => {
            let radius = entity.number(40, 0.0)?;
            if radius == 0.0 {
                // A shape without size is no object.
                return Ok(EntityGeometry::Nothing);
            }
            if radius < 0.0 {
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
        "LWPOLYLINE" | "POLYLINE" => return polyline::read(entity, transform),
        "SPLINE" => return spline::read(entity, transform),
        kind if is_annotation(kind) => Ok(EntityGeometry::Nothing),
        kind => Err(unsupported(&shown(kind), "explode it into lines and arcs, or take it out")),
    };
    Ok(drawn?)
}

/// The transform of an entity's own coordinates. The x axis of an entity that is seen from below is reversed.
pub(super) fn object_transform(entity: &Record<'_>, transform: &Transform) -> Result<Transform, OutlineError> {
    let [x, y, z] = [entity.number(210, 0.0)?, entity.number(220, 0.0)?, entity.number(230, 1.0)?];
    let is_level = z != 0.0 && x.abs() + y.abs() <= 1e-9 * z.abs();
    if !is_level {
        return Err(unsupported("an entity that is tilted", "draw it in the x-y plane").into());
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

pub(super) fn unsupported(what: &str, advice: &'static str) -> OutlineFault {
    OutlineFault::Unsupported { what: what.to_owned(), advice }
}
