//! Outlines around the origin.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::sampler::Sampler;
use vibrissa_declare::catalogue::Parameter;
use vibrissa_runtime::math;
use vibrissa_world::geometry::{Contour, Piece, Vector2, perpendicular, unit};

/// Largest share of a side that the rounding of one of its ends replaces.
const ROUNDED: f64 = 0.4;
/// Least radius (m) of a rounded corner.
const MIN_RADIUS: f64 = 2e-3;
/// The golden ratio. Its multiples are distributed evenly over a unit interval, so any share of them is, too.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Number of points of an arc.
const POINTS: u32 = 32;

/// The corners of a random convex polygon around the origin, counter-clockwise. They are on a circle, with a least
/// distance between neighbours. `phase` is the direction of the first one, `shifts` are displacements of the corners.
pub(super) fn convex_polygon(
    sampler: &mut Sampler<'_>,
    radius: f64,
    corners: u32,
    phase: &Parameter,
    shifts: &[Parameter],
) -> Vec<Vector2> {
    let (phase, step) = (sampler.number(phase), TAU / f64::from(corners));
    let corner = |(k, shift)| radius * unit(phase + step * (f64::from(k) + sampler.number(shift)));
    (0..corners).zip(shifts).map(corner).collect()
}

/// Points on a circle around the origin.
pub(super) fn disk(radius: f64) -> Vec<Vector2> {
    arc(radius, 0.0, TAU).collect()
}

/// The directions of the sides before and after a corner of a closed polygon, and its turning angle (rad).
pub(super) fn turn(corners: &[Vector2], k: usize) -> (Vector2, Vector2, f64) {
    let count = corners.len();
    let corner = |k: usize| corners[k % count];
    let (into, out) = (corner(k) - corner(k + count - 1), corner(k + 1) - corner(k));
    (into, out, turning_angle(into, out))
}

/// The angle (rad) from a direction to another, positive to the left.
pub(super) fn turning_angle(from: Vector2, to: Vector2) -> f64 {
    math::atan2(from.perp(&to), from.dot(&to))
}

/// Points on a convex polygon, counter-clockwise, whose corners are rounded by these radii (m).
pub(super) fn rounded(corners: &[Vector2], radii: &[f64]) -> Vec<Vector2> {
    let corner = |k: usize| {
        let (into, out, turn) = turn(corners, k);
        let inwards = (out.normalize() - into.normalize()).normalize();
        let centre = corners[k] + radii[k] / math::cos(0.5 * turn) * inwards;
        arc(radii[k], math::atan2(into.y, into.x) - FRAC_PI_2, turn).map(move |point| centre + point)
    };
    (0..corners.len()).flat_map(corner).collect()
}

fn arc(radius: f64, from: f64, sweep: f64) -> impl Iterator<Item = Vector2> {
    (0..=POINTS).map(move |k| radius * unit(from + sweep * f64::from(k) / f64::from(POINTS)))
}

/// An outline with a `share` of its corners between straight sides rounded by these radii (m): of convex corners, of concave
/// ones. Short sides reduce a radius, or leave the corner sharp.
pub(super) fn fillet(outline: &Contour, radii: [f64; 2], share: f64) -> Contour {
    let pieces = outline.pieces();
    let mut count = 0.0;
    // For every piece, the turn (rad) and the radius (m) at its start.
    let corners: Vec<(f64, f64)> = (0..pieces.len())
        .map(|index| {
            let (before, after) = (&pieces[(index + pieces.len() - 1) % pieces.len()], &pieces[index]);
            let (Piece::Segment(into), Piece::Segment(out)) = (before, after) else { return (0.0, 0.0) };
            let turn = turning_angle(into.tangent(), out.tangent());
            count += 1.0;
            let room = ROUNDED * into.length().min(out.length()) / math::tan(0.5 * turn.abs());
            let radius = radii[usize::from(turn < 0.0)].min(room);
            let is_rounded = (GOLDEN * count).fract() < share && radius >= MIN_RADIUS;
            (turn, if is_rounded { radius } else { 0.0 })
        })
        .collect();
    let mut rounded = Vec::with_capacity(2 * pieces.len());
    for (index, piece) in pieces.iter().enumerate() {
        let Piece::Segment(side) = piece else {
            rounded.push(*piece);
            continue;
        };
        let [(before, at_start), (turn, radius)] = [corners[index], corners[(index + 1) % pieces.len()]];
        let taken = |(turn, radius): (f64, f64)| radius * math::tan(0.5 * turn.abs());
        let end = side.point_at(side.length() - taken((turn, radius)));
        rounded.push(Piece::segment(side.point_at(taken((before, at_start))), end));
        if radius > 0.0 {
            let (along, left) = (side.tangent(), turn.signum());
            let from = math::atan2(along.y, along.x) - left * FRAC_PI_2;
            rounded.push(Piece::arc(end + left * radius * perpendicular(along), radius, from, turn));
        }
    }
    // Roundings that meet another side are left out.
    Contour::closed(rounded).unwrap_or_else(|_| outline.clone())
}
