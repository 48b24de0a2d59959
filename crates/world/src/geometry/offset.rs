//! Parallel contours (offset curves).

use std::f64::consts::TAU;

use cavalier_contours::polyline::{
    PlineOffsetOptions, PlineSource, PlineSourceMut, PlineVertex, Polyline, TouchingLoopBehavior,
};
use vibrissa_runtime::math;

use super::{Arc, Contour, JOIN_TOLERANCE, MIN_PIECE_LENGTH, Piece, Point2, Vector2, perpendicular, rotate};

/// The largest error (m) of a parallel contour. Its corners are intersections, which are less accurate than its pieces.
const TOLERANCE: f64 = 2e-8;

/// A change of the distance (m) that keeps a parallel contour within the tolerance.
const NUDGE: f64 = 0.5 * TOLERANCE;

/// The scale for the library of offsets and differences. The library compares squared lengths with a constant 1e-8. In millimetres, this is
/// far below the resolution of a contour.
pub(super) const PER_METRE: f64 = 1e3;

/// The reason why there is no parallel contour.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OffsetError {
    /// The distance is infinite or not a number.
    #[error("the offset distance is {distance}: it must be a finite number")]
    NotFinite {
        /// The distance.
        distance: f64,
    },
    /// The result fails its verification.
    #[error(
        "the parallel contour at {distance} m is degenerate: it touches itself, splits or vanishes; \
         use a distance that is a micrometre larger or smaller"
    )]
    Unsound {
        /// The distance (m).
        distance: f64,
    },
}

impl Contour {
    /// The contours parallel to this one at a signed `distance` (m): positive on the right of the direction of travel,
    /// which is the outside of a closed contour, negative on the left.
    ///
    /// They consist of the points at that distance from the whole contour, on that side of it. Corners are rounded on
    /// their outside and trimmed on their inside. There may be several contours, or none if there is no space. Those of
    /// a closed contour are closed and counter-clockwise. A contour around a gap with a closed mouth has the gap
    /// inside. Those of an open contour lack the caps around its ends and have its direction. One that meets its own
    /// start is closed.
    ///
    /// The error is at most 20 nm. A smaller distance gives the contour itself.
    ///
    /// ```
    /// use std::f64::consts::PI;
    /// use vibrissa_world::geometry::{Point2, rounded_rectangle};
    /// let side = rounded_rectangle(Point2::origin(), 0.2, 0.1, 0.0, 0.0)?;
    /// let outside = side.offset(0.01)?;
    /// assert_eq!(outside.len(), 1);
    /// assert!((outside[0].length() - (0.6 + 0.02 * PI)).abs() < 1e-12);
    /// assert!(side.offset(-0.06)?.is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`OffsetError`] if the distance is not finite, or if no result passes the verification. The second case is rare: at
    /// exactly this distance, the parallel contour touches itself, splits or vanishes, and rounding determines its form.
    /// A distance that differs by a micrometre has a result.
    pub fn offset(&self, distance: f64) -> Result<Vec<Self>, OffsetError> {
        if !distance.is_finite() {
            return Err(OffsetError::NotFinite { distance });
        }
        if distance.abs() <= TOLERANCE {
            return Ok(vec![self.clone()]);
        }
        // At a distance at which a parallel touches itself, splits or vanishes, a slightly larger one is equivalent.
        let beyond = distance + NUDGE * distance.signum();
        let found = [distance, beyond].into_iter().find_map(|distance| self.parallel(distance));
        found.ok_or(OffsetError::Unsound { distance })
    }

    /// The parallels at a distance, if they pass the verification.
    fn parallel(&self, distance: f64) -> Option<Vec<Self>> {
        let bounds = self.bounding_box();
        let origin = nalgebra::center(&bounds.min, &bounds.max);
        let options = PlineOffsetOptions {
            pos_equal_eps: JOIN_TOLERANCE * PER_METRE,
            offset_dist_eps: NUDGE * PER_METRE,
            touching_loop_behavior: TouchingLoopBehavior::Separate,
            ..PlineOffsetOptions::default()
        };
        // The library counts a distance to the left as positive.
        let found = to_polyline(self, origin).parallel_offset_opt(-distance * PER_METRE, &options);
        let found = stitched(found).into_iter().map(|polyline| (to_pieces(&polyline, origin), polyline.is_closed()));
        // At a cusp the library also returns the half circle on the other side.
        let found = found.filter(|(pieces, _)| pieces.iter().all(|piece| self.is_beside(piece, distance)));
        let found = found.map(|(pieces, closed)| if closed { Self::closed(pieces) } else { Self::open(pieces) });
        let found = found.collect::<Result<Vec<_>, _>>().ok()?;
        self.has_parallel(&found, distance).then_some(found)
    }

    /// True if the middle of a piece is on the side of this contour that the sign of the distance determines.
    fn is_beside(&self, piece: &Piece, distance: f64) -> bool {
        self.signed_distance(piece.point_at(0.5 * piece.length())) * distance > 0.0
    }

    /// True if the contours have the distance and lack no points at it.
    fn has_parallel(&self, found: &[Self], distance: f64) -> bool {
        const ALONG: [f64; 5] = [0.0, 0.02, 0.5, 0.98, 1.0];
        // The sides are checked elsewhere. Beyond an end of an open contour they meet.
        let at_distance = |point| (self.nearest(point).distance - distance.abs()).abs() <= TOLERANCE;
        let sound = found
            .iter()
            .flat_map(|contour| &contour.pieces)
            .all(|piece| ALONG.iter().all(|share| at_distance(piece.point_at(share * piece.length()))));
        let covered = |point: Point2| {
            // Points nearer to another part of the contour are trimmed, so their absence is correct.
            (self.signed_distance(point) - distance).abs() > 0.1 * JOIN_TOLERANCE
                || found.iter().any(|contour| contour.nearest(point).distance <= TOLERANCE)
        };
        let beside = |piece: &Piece| {
            let piece = *piece;
            ALONG.into_iter().map(move |share| {
                let s = share * piece.length();
                piece.point_at(s) - perpendicular(piece.tangent_at(s)) * distance
            })
        };
        let round = self.corners().into_iter().filter(|corner| corner.turn * distance > 0.0).map(|corner| {
            let outgoing = self.tangent_at(corner.arc_length);
            let middle = rotate(outgoing, -0.5 * corner.turn);
            corner.point - perpendicular(middle) * distance
        });
        sound && self.pieces.iter().flat_map(beside).chain(round).all(covered)
    }
}

pub(super) fn to_polyline(contour: &Contour, origin: Point2) -> Polyline {
    let mut polyline = if contour.closed { Polyline::new_closed() } else { Polyline::new() };
    let mut add = |point: Point2, bulge| {
        let point = (point - origin) * PER_METRE;
        polyline.add(point.x, point.y, bulge);
    };
    for piece in &contour.pieces {
        match piece {
            Piece::Segment(segment) => add(segment.start, 0.0),
            Piece::Arc(arc) => {
                // The library's arcs are at most half circles.
                let parts = (arc.sweep.abs() / 3.0).ceil();
                for part in (0..3_u8).map(f64::from).take_while(|&part| part < parts) {
                    add(arc.point_at(arc.length() * part / parts), math::tan(0.25 * arc.sweep / parts));
                }
            }
        }
    }
    if !contour.closed {
        add(contour.point_at(contour.length), 0.0);
    }
    polyline
}

/// Joins open parallels whose ends meet.
///
/// If a contour ends with an arc, the circle around its end touches the parallel of the arc. Intersections with both
/// are then equal within the library's tolerance, but not within the tolerance of contours. The library returns
/// separate parts there, with slivers between the intersections.
fn stitched(found: Vec<Polyline>) -> Vec<Polyline> {
    let meet = |end: &Polyline, start: &Polyline| {
        let vertex = end.last().zip(start.get(0));
        vertex.is_some_and(|(end, start)| (end.pos() - start.pos()).length() <= TOLERANCE * PER_METRE)
    };
    let long = found.into_iter().filter(|polyline| polyline.path_length() > TOLERANCE * PER_METRE);
    let (mut whole, mut parts): (Vec<_>, Vec<_>) = long.partition(PlineSource::is_closed);
    while let Some(mut part) = parts.pop() {
        if let Some(before) = parts.iter().position(|before| meet(before, &part)) {
            parts[before].remove_last();
            parts[before].extend_vertexes(part.iter_vertexes());
            continue;
        }
        if let Some(next) = parts.iter().position(|next| meet(&part, next)) {
            part.remove_last();
            part.extend_vertexes(parts.swap_remove(next).iter_vertexes());
            parts.push(part);
            continue;
        }
        if part.vertex_count() > 2 && meet(&part, &part) {
            part.remove_last();
            part.set_is_closed(true);
        }
        whole.push(part);
    }
    whole
}

pub(super) fn to_pieces(polyline: &Polyline, origin: Point2) -> Vec<Piece> {
    let cleaned = polyline.remove_repeat_pos(MIN_PIECE_LENGTH * PER_METRE);
    let polyline = cleaned.as_ref().unwrap_or(polyline);
    let mut pieces: Vec<Piece> = Vec::with_capacity(polyline.vertex_count());
    for (from, to) in polyline.iter_segments() {
        let piece = to_piece(from, to, origin);
        match (pieces.last_mut(), piece) {
            (Some(Piece::Arc(last)), Piece::Arc(arc)) if continues(last, &arc) => {
                last.sweep = (last.sweep + arc.sweep).clamp(-TAU, TAU);
            }
            _ => pieces.push(piece),
        }
    }
    pieces
}

fn to_piece(from: PlineVertex, to: PlineVertex, origin: Point2) -> Piece {
    let [start, end] = [from, to].map(|vertex| origin + Vector2::new(vertex.x, vertex.y) / PER_METRE);
    if from.bulge == 0.0 {
        return Piece::segment(start, end);
    }
    let chord = end - start;
    // The bulge is the tangent of a quarter of the sweep.
    let to_centre = perpendicular(chord) * ((1.0 - from.bulge * from.bulge) / (4.0 * from.bulge));
    let centre = nalgebra::center(&start, &end) + to_centre;
    let outward = start - centre;
    Piece::arc(centre, outward.norm(), math::atan2(outward.y, outward.x), 4.0 * math::atan(from.bulge))
}

/// True if `next` continues on the circle of `last`.
fn continues(last: &Arc, next: &Arc) -> bool {
    const SAME: f64 = 1e-3 * JOIN_TOLERANCE;
    (next.centre - last.centre).norm() <= SAME
        && (next.radius - last.radius).abs() <= SAME
        && next.sweep.signum() == last.sweep.signum()
}
