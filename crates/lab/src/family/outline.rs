//! Outlines around the origin.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::sampler::Sampler;
use vibrissa_declare::catalogue::Parameter;
use vibrissa_world::geometry::{Vector2, unit};

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
    (into, out, into.perp(&out).atan2(into.dot(&out)))
}

/// Points on a convex polygon, counter-clockwise, whose corners are rounded by these radii (m).
pub(super) fn rounded(corners: &[Vector2], radii: &[f64]) -> Vec<Vector2> {
    let corner = |k: usize| {
        let (into, out, turn) = turn(corners, k);
        let inwards = (out.normalize() - into.normalize()).normalize();
        let centre = corners[k] + radii[k] / (0.5 * turn).cos() * inwards;
        arc(radii[k], into.y.atan2(into.x) - FRAC_PI_2, turn).map(move |point| centre + point)
    };
    (0..corners.len()).flat_map(corner).collect()
}

fn arc(radius: f64, from: f64, sweep: f64) -> impl Iterator<Item = Vector2> {
    (0..=POINTS).map(move |k| radius * unit(from + sweep * f64::from(k) / f64::from(POINTS)))
}
