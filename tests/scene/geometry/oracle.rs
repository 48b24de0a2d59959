//! Slow and simple answers to hold the fast ones against.

use std::f64::consts::TAU;

use vibrissa::geometry::{Contour, Piece, Point2, rotate, unit};

/// What rounding does to lengths (m) of contours and arcs of a few metres.
pub(crate) const ROUNDING: f64 = 1e-13;

/// Whether a point is inside a closed contour, by the parity of the crossings of a ray in a direction (rad).
pub(crate) fn inside(contour: &Contour, point: Point2, direction: f64) -> bool {
    let crossings: usize = contour.pieces().iter().map(|piece| crossings(piece, point, direction)).sum();
    crossings % 2 == 1
}

fn crossings(piece: &Piece, point: Point2, direction: f64) -> usize {
    // In a frame at the point whose x axis is the ray.
    let local = |world: Point2| rotate(world - point, -direction);
    match piece {
        Piece::Segment(segment) => {
            let (a, b) = (local(segment.start), local(segment.end));
            usize::from((a.y > 0.0) != (b.y > 0.0) && a.x - a.y * (b.x - a.x) / (b.y - a.y) > 0.0)
        }
        Piece::Arc(arc) => {
            let centre = local(arc.centre);
            if centre.y.abs() >= arc.radius {
                return 0;
            }
            let half_chord = (arc.radius * arc.radius - centre.y * centre.y).sqrt();
            let on_ray_and_arc = |x: f64| {
                let angle = (-centre.y).atan2(x - centre.x) + direction;
                let travelled = ((angle - arc.start_angle) * arc.sweep.signum()).rem_euclid(TAU);
                x > 0.0 && travelled < arc.sweep.abs()
            };
            [centre.x - half_chord, centre.x + half_chord].into_iter().filter(|&x| on_ray_and_arc(x)).count()
        }
    }
}

/// The distance from a point to the nearest of a contour's pieces, by trying each, each by its definition.
pub(crate) fn distance(contour: &Contour, point: Point2) -> f64 {
    contour.pieces().iter().map(|piece| piece_distance(piece, point)).fold(f64::INFINITY, f64::min)
}

fn piece_distance(piece: &Piece, point: Point2) -> f64 {
    match piece {
        Piece::Segment(segment) => {
            let along = segment.end - segment.start;
            let share = ((point - segment.start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            (segment.start + along * share - point).norm()
        }
        Piece::Arc(arc) => {
            let outward = point - arc.centre;
            let angle = outward.y.atan2(outward.x);
            let travelled = ((angle - arc.start_angle) * arc.sweep.signum()).rem_euclid(TAU);
            let ends = [arc.start_angle, arc.start_angle + arc.sweep];
            let mut candidates = ends.map(|end| (arc.centre + arc.radius * unit(end) - point).norm()).to_vec();
            if travelled < arc.sweep.abs() {
                candidates.push((outward.norm() - arc.radius).abs());
            }
            candidates.into_iter().fold(f64::INFINITY, f64::min)
        }
    }
}
