//! Closed solutions of the literature.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use proptest::prelude::*;
use vibrissa::geometry::{Vector2, rotate};
use vibrissa_runtime::mechanics::Elastica;

use crate::mechanics::whisker::{any, any_tapered, bent, force_unit, moment_unit, with_ratio};

/// Carlson's integral of the first kind, by duplication (Numerische Mathematik 33 (1979), 1).
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    for _ in 0..60 {
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
    ((x + y + z) / 3.0).sqrt().recip()
}

/// Carlson's integral of the second kind.
fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    for _ in 0..60 {
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += factor / (z.sqrt() * (z + lambda));
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
        factor *= 0.25;
    }
    3.0 * sum + factor / ((x + y + 3.0 * z) / 5.0).powf(1.5)
}

/// Legendre's incomplete integrals of the first and second kind, `F(φ, k)` and `E(φ, k)`.
fn legendre(phi: f64, k: f64) -> (f64, f64) {
    let (sin, cos) = phi.sin_cos();
    let (c2, delta2) = (cos * cos, 1.0 - (k * sin).powi(2));
    let first = sin * carlson_rf(c2, delta2, 1.0);
    (first, first - k * k * sin.powi(3) / 3.0 * carlson_rd(c2, delta2, 1.0))
}

/// A clamped elastica under a tip force, by elliptic integrals. Its angle against the direction opposite to the force swings
/// like a pendulum from its amplitude, at the tip. In units of the length, `EI / L²` and `EI / L`.
struct Pendulum {
    force: f64,
    moment: f64,
    /// Direction of the force, counted from the shaft at the base (rad).
    direction: f64,
    /// Direction of the shaft at the tip, counted from that at the base (rad).
    tip_angle: f64,
    tip: Vector2,
}

impl Pendulum {
    /// With an amplitude (rad) and the phase at the base: π/2 at the tip, 0 where the shaft is opposite to the force.
    fn new(amplitude: f64, phase: f64) -> Self {
        let k = (0.5 * amplitude).sin();
        let (whole, part) = (legendre(FRAC_PI_2, k), legendre(phase, k));
        let rate = whole.0 - part.0;
        let root = 2.0 * (k * phase.sin()).asin();
        // Against the force, and across it.
        let along = (2.0 * (whole.1 - part.1) - rate) / rate;
        let across = 2.0 * k * phase.cos() / rate;
        Self {
            force: rate * rate,
            moment: rate * 2.0 * k * phase.cos(),
            direction: PI - root,
            tip_angle: amplitude - root,
            tip: rotate(Vector2::new(along, across), -root),
        }
    }
}

#[test]
fn legendres_integrals_are_those_of_the_tables() {
    // Abramowitz and Stegun, tables 17.1, 17.5 and 17.6.
    let sixty = 60_f64.to_radians();
    for (phi, modular, first, second) in [
        (FRAC_PI_2, 30.0_f64, 1.685_750_354_812_6, 1.467_462_209_339_4),
        (FRAC_PI_2, 45.0, 1.854_074_677_301_4, 1.350_643_881_047_7),
        (sixty, 30.0, 1.089_550_67, 1.007_555_56),
    ] {
        let (f, e) = legendre(phi, modular.to_radians().sin());
        assert!((f - first).abs() < 1e-8 && (e - second).abs() < 1e-8, "{phi} {modular}: {f} {e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_uniform_shaft_swings_like_a_pendulum(whisker in any(), amplitude in 0.05..2.6_f64, phase in -0.6..1.4_f64) {
        let exact = Pendulum::new(amplitude, phase);
        let length = whisker.shaft.length;
        let base_angle = exact.moment * moment_unit(&whisker) / whisker.hinge.stiffness;
        let bend = bent(&whisker, length, exact.moment, base_angle + exact.direction);
        prop_assert!(bend.is_some());
        let bend = bend.unwrap();
        prop_assert!((bend.tip_base - length * rotate(exact.tip, base_angle)).norm() < 1e-9 * length);
        prop_assert!((bend.tip_angle - base_angle - exact.tip_angle).abs() < 1e-9);
        let unit = force_unit(&whisker);
        prop_assert!((bend.force / unit - exact.force).abs() < 1e-9 * exact.force);
        prop_assert!((bend.shear / unit - exact.force * exact.direction.sin()).abs() < 1e-9 * exact.force);
        prop_assert!((bend.axial / unit - exact.force * exact.direction.cos()).abs() < 1e-9 * exact.force);
    }
}

/// Bisshopp and Drucker's cantilever, in the figures that Mattiasson computed for it (International Journal for Numerical
/// Methods in Engineering 17 (1981), 145): the load over `EI / L²`, how far the tip moves across and back over `L`, its
/// angle (rad).
const MATTIASSON: [[f64; 4]; 6] = [
    [0.2, 0.066_36, 0.002_65, 0.099_64],
    [0.4, 0.130_98, 0.010_35, 0.197_16],
    [1.0, 0.301_72, 0.056_43, 0.461_35],
    [2.0, 0.493_46, 0.160_64, 0.781_75],
    [5.0, 0.713_79, 0.387_63, 1.215_37],
    [10.0, 0.810_61, 0.555_00, 1.430_29],
];

#[test]
fn a_clamped_cantilever_bends_as_bisshopp_and_drucker_found() {
    let whisker = with_ratio(0.1, 0.125e-3, 1e12);
    for [load, across, back, angle] in MATTIASSON {
        let bend = bent(&whisker, 0.1, load * (1.0 - back), FRAC_PI_2).unwrap();
        // The table has five digits; so has the moment that is taken from it.
        assert!((bend.force / force_unit(&whisker) / load - 1.0).abs() < 2e-4);
        let found = [bend.tip_base.y / 0.1, 1.0 - bend.tip_base.x / 0.1, bend.tip_angle];
        for (found, due) in found.into_iter().zip([across, back, angle]) {
            assert!((found - due).abs() < 6e-5, "{load}: {found} {due}");
        }
        // And exactly, by elliptic integrals: the shaft at the base is square to the force.
        let phase = |amplitude: f64| (FRAC_PI_4.sin() / (0.5 * amplitude).sin()).asin();
        let (mut least, mut most) = (FRAC_PI_2, PI - 1e-6);
        for _ in 0..60 {
            let middle = f64::midpoint(least, most);
            let moment = Pendulum::new(middle, phase(middle)).moment;
            if moment < load * (1.0 - back) { least = middle } else { most = middle }
        }
        let exact = Pendulum::new(least, phase(least));
        assert!((bend.tip_base - 0.1 * exact.tip).norm() < 1e-10, "{load}");
    }
}

/// A column on a hinge buckles at `z² EI / L²`, with `z tan z = k L / EI`; a clamped one at `z = π/2`.
#[test]
fn a_force_along_the_shaft_bends_it_from_eulers_load_on() {
    for ratio in [0.5, 3.0, 52.0, 1e9] {
        let whisker = with_ratio(0.1, 0.125e-3, ratio);
        let (mut least, mut most) = (0.0, FRAC_PI_2);
        for _ in 0..60 {
            let z: f64 = f64::midpoint(least, most);
            if z * z.tan() < ratio { least = z } else { most = z }
        }
        let elastica = Elastica::new(&whisker);
        let aside = bent(&whisker, 0.1, 1e-3, 3.0).unwrap();
        let bend = elastica.solve_tip(aside.base_angle, PI, &aside).unwrap();
        assert!((bend.force / force_unit(&whisker) / (least * least) - 1.0).abs() < 1e-5, "{ratio}");
    }
}

proptest! {
    /// A beam whose radius goes evenly from `r` to `q r` moves at its end by `1 / q` and turns by `(1 + 2 q) / (3 q²)` of
    /// what a uniform one does.
    #[test]
    fn a_small_bend_is_that_of_a_beam(whisker in any_tapered(), share in 0.05..1.0_f64, direction in 0.5..2.6_f64) {
        let (length, stiffness) = (whisker.shaft.length, whisker.shaft.bending_stiffness());
        let taper = whisker.shaft.radius_at(share) / whisker.shaft.radius;
        let contact = share * length;
        let bend = bent(&whisker, contact, 1e-6, direction).unwrap();
        let across = bend.force * direction.sin();
        let aside = across * contact.powi(3) / (3.0 * stiffness * taper) + bend.base_angle * contact;
        let turn = across * contact.powi(2) / (2.0 * stiffness) * (1.0 + 2.0 * taper) / (3.0 * taper * taper) + bend.base_angle;
        prop_assert!((bend.base_angle * whisker.hinge.stiffness / (across * contact) - 1.0).abs() < 1e-4);
        prop_assert!((bend.contact_base.y / aside - 1.0).abs() < 1e-4);
        prop_assert!((bend.tip_angle / turn - 1.0).abs() < 1e-4);
        prop_assert!((bend.tip_base.y / (aside + turn * (length - contact)) - 1.0).abs() < 1e-4);
    }
}
