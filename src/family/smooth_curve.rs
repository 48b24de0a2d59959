//! Random smooth closed curves.

use std::f64::consts::{PI, TAU};

use super::Family;
use super::layout::{Aim, Layout, REFERENCE, polar};
use super::position::{ahead, beside};
use super::sampler::Sampler;
use crate::geometry::{Harmonic, Vector2, unit};

pub(super) const FAMILY: Family = Family {
    name: "smooth-curve",
    about: "a smooth closed curve with up to five bulges, and radii of at least 8 cm outwards and 25 cm inwards",
    lay,
};

/// Largest curvature of a convex part (1/m). A tip that slides around it does not snap off.
const MAX_CONVEX: f64 = 1.0 / 0.08;
/// Largest curvature of a concave part (1/m). A whisker can slide along it without a contact of the nose, which is 108
/// mm ahead of the centre of mass.
const MAX_CONCAVE: f64 = 1.0 / 0.25;

/// Number of angles at which the curvature is computed.
const ANGLES: u32 = 720;
/// Factor of the harmonics each time that the curvature is too large.
const FLATTER: f64 = 0.95;

fn lay(sampler: &mut Sampler) -> Layout {
    let hand = sampler.side();
    let radius = sampler.between(0.2, 0.35);
    let mut harmonics: Vec<Harmonic> = (2..=5)
        .map(|order| {
            let amplitude = sampler.between(0.0, 0.4) * radius / f64::from(order);
            Harmonic { order, amplitude, phase: sampler.between(-PI, PI) }
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
        (r * r + 2.0 * slope * slope - r * bend) / (r * r + slope * slope).powf(1.5)
    };
    angles()
        .map(curvature)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), here| (least.min(here), most.max(here)))
}

/// The distance of a curve from its centre at an angle, and its first two derivatives (m).
fn distance(radius: f64, harmonics: &[Harmonic], angle: f64) -> [f64; 3] {
    harmonics.iter().fold([radius, 0.0, 0.0], |[r, slope, bend], &Harmonic { order, amplitude, phase }| {
        let order = f64::from(order);
        let (sin, cos) = (order * angle + phase).sin_cos();
        [r + amplitude * cos, slope - order * amplitude * sin, bend - order * order * amplitude * cos]
    })
}

fn angles() -> impl Iterator<Item = f64> {
    (0..=ANGLES).map(|k| TAU * f64::from(k) / f64::from(ANGLES))
}
