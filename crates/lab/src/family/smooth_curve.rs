//! Random smooth closed curves.

use std::f64::consts::TAU;

use super::layout::{Aim, Layout, REFERENCE, polar};
use super::position::{ahead, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::SIDE;
use vibrissa_declare::catalogue::smooth_curve::{PHASES, RADIUS, WAVES};
use vibrissa_runtime::math;
use vibrissa_world::geometry::{Harmonic, Vector2, unit};

/// Largest curvature of a convex part (1/m). A tip that slides around it does not snap off.
const MAX_CONVEX: f64 = 1.0 / 0.08;
/// Largest curvature of a concave part (1/m). A whisker can slide along it without a contact of the nose, which is 108
/// mm ahead of the centre of mass.
const MAX_CONCAVE: f64 = 1.0 / 0.25;

/// Number of angles at which the curvature is computed.
const ANGLES: u32 = 720;
/// Factor of the harmonics each time that the curvature is too large.
const FLATTER: f64 = 0.95;

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let hand = sampler.side(&SIDE);
    let radius = sampler.number(&RADIUS);
    let waves = (2..).zip(WAVES.iter().zip(&PHASES));
    let mut harmonics: Vec<Harmonic> = waves
        .map(|(order, (wave, phase))| {
            let amplitude = sampler.number(wave) * radius / f64::from(order);
            Harmonic { order, amplitude, phase: sampler.number(phase) }
        })
        .collect();
    let mut curvatures = curvatures(radius, &harmonics);
    // A circle satisfies both limits, so the loop ends.
    while curvatures.0 < -MAX_CONCAVE || curvatures.1 > MAX_CONVEX {
        for harmonic in &mut harmonics {
            harmonic.amplitude *= FLATTER;
        }
        curvatures = self::curvatures(radius, &harmonics);
    }
    let outline: Vec<_> = angles().map(|angle| distance(radius, &harmonics, angle)[0] * unit(angle)).collect();
    let inwards =
        if curvatures.0 < 0.0 { format!(", hollows of {:.0} mm", -1e3 / curvatures.0) } else { String::new() };
    Layout {
        about: format!("bulges of {:.0} mm{inwards}", 1e3 / curvatures.1),
        objects: vec![polar(ahead(sampler, hand, &outline), radius, &harmonics)],
        start: beside(hand),
        aim: Aim::Loop,
        path_length: outline.windows(2).map(|ends: &[Vector2]| (ends[1] - ends[0]).norm()).sum(),
        rig: REFERENCE,
    }
}

/// The least and the greatest curvature (1/m) of a curve, positive in convex parts.
fn curvatures(radius: f64, harmonics: &[Harmonic]) -> (f64, f64) {
    let curvature = |angle| {
        let [r, slope, bend] = distance(radius, harmonics, angle);
        (r * r + 2.0 * slope * slope - r * bend) / math::powf(r * r + slope * slope, 1.5)
    };
    angles()
        .map(curvature)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), here| (least.min(here), most.max(here)))
}

/// The distance of a curve from its centre at an angle, and its first two derivatives (m).
fn distance(radius: f64, harmonics: &[Harmonic], angle: f64) -> [f64; 3] {
    harmonics.iter().fold([radius, 0.0, 0.0], |[r, slope, bend], &Harmonic { order, amplitude, phase }| {
        let order = f64::from(order);
        let (sin, cos) = math::sin_cos(order * angle + phase);
        [r + amplitude * cos, slope - order * amplitude * sin, bend - order * order * amplitude * cos]
    })
}

fn angles() -> impl Iterator<Item = f64> {
    (0..=ANGLES).map(|k| TAU * f64::from(k) / f64::from(ANGLES))
}
