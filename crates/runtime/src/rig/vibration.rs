//! The first mode in which a free whisker vibrates.

use std::f64::consts::TAU;

use super::Whisker;
use crate::math;

/// Steps of the iteration for the mode. The second mode has a frequency at least four times higher, so each step reduces its share
/// by a factor of 16 or more.
const STEPS: usize = 12;

/// The first mode in which a free whisker vibrates about its rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibration {
    /// Angular frequency (rad/s), without damping.
    pub frequency: f64,
    /// Time in which the amplitude decreases to 1/e (s). It is infinite without damping.
    pub decay: f64,
}

impl Vibration {
    /// The first mode of a whisker: the one that is stated, or else that of the chain of links that the simulators use.
    #[must_use]
    pub fn of(whisker: &Whisker) -> Self {
        let vibrating = whisker.vibrating();
        let Shape { stiffness, mass, damping_of_hinge, of_shaft } = Shape::of(&vibrating);
        let damping = damping_of_hinge + vibrating.shaft.damping * of_shaft;
        Self { frequency: (stiffness / mass).sqrt(), decay: 2.0 * mass / damping }
    }

    /// Time (s) in which a free whisker comes nearer to rest by a factor e. It is [`decay`](Self::decay) of a whisker that swings. A
    /// whisker with more than critical damping creeps back in the longer time `(rate + (rate² - frequency²)^½) / frequency²`, where
    /// `rate` is the inverse of `decay`.
    #[must_use]
    pub fn relaxation(&self) -> f64 {
        let rate = self.decay.recip();
        let creeping = math::square(rate) - math::square(self.frequency);
        if creeping > 0.0 { (rate + creeping.sqrt()) / math::square(self.frequency) } else { self.decay }
    }
}

impl Whisker {
    /// The whisker with the masses and the damping of the shaft that give its mechanics the stated first mode and decay.
    ///
    /// All masses change by the same factor, so the shape of the mode stays the same. The hinge keeps its damping, which
    /// hardly contributes to that of the mode and delays readings.
    #[must_use]
    pub fn vibrating(&self) -> Self {
        let mut whisker = self.clone();
        if self.first_mode.is_none() && self.decay.is_none() {
            return whisker;
        }
        let Shape { stiffness, mut mass, damping_of_hinge, of_shaft } = Shape::of(self);
        if let Some(frequency) = self.first_mode {
            let factor = stiffness / (mass * math::square(TAU * frequency));
            whisker.shaft.density *= factor;
            whisker.hinge.armature *= factor;
            mass *= factor;
        }
        if let Some(decay) = self.decay {
            whisker.shaft.damping = math::max(2.0 * mass / decay - damping_of_hinge, 0.0) / of_shaft;
        }
        (whisker.first_mode, whisker.decay) = (None, None);
        whisker
    }
}

/// The shape of the first mode, by what Rayleigh's quotient needs: sums over all parts of the chain, for one amplitude.
struct Shape {
    /// Stiffness (N m) of shaft and hinge.
    stiffness: f64,
    /// Mass (kg m²).
    mass: f64,
    /// Damping (N m s) of the hinge.
    damping_of_hinge: f64,
    /// Stiffness (N m) of the shaft, to which its damping is proportional.
    of_shaft: f64,
}

impl Shape {
    /// The inertial forces of a shape bend the chain into the next shape (Stodola's method). A link is a mass at its
    /// centre.
    fn of(whisker: &Whisker) -> Self {
        let (shaft, hinge) = (&whisker.shaft, &whisker.hinge);
        let length = shaft.link_length();
        let masses: Vec<_> = (0..shaft.links).map(|link| shaft.link_mass(link)).collect();
        let stiffnesses: Vec<_> = shaft.joint_stiffnesses().collect();
        // The base hinge, and a joint at the base of each link.
        let mut hinge_angle = 1.0;
        let mut angles = vec![0.0; shaft.links];
        for _ in 0..STEPS {
            let moments = moments(&masses, &offsets(hinge_angle, &angles, length), length);
            let base = moments.first().copied().unwrap_or_default();
            hinge_angle = (base + hinge.armature * hinge_angle) / hinge.stiffness;
            for ((angle, moment), stiffness) in angles.iter_mut().zip(moments).zip(&stiffnesses) {
                *angle = moment / stiffness;
            }
            // Only the shape matters. Without this, the numbers would decrease until they are zero.
            let size = (hinge_angle * hinge_angle + angles.iter().map(|angle| angle * angle).sum::<f64>()).sqrt();
            hinge_angle /= size;
            for angle in &mut angles {
                *angle /= size;
            }
        }
        let of_hinge = hinge_angle * hinge_angle;
        let of_shaft: f64 = angles.iter().zip(&stiffnesses).map(|(angle, stiffness)| stiffness * angle * angle).sum();
        let moved = offsets(hinge_angle, &angles, length);
        let mass = hinge.armature * of_hinge
            + masses.iter().zip(moved).map(|(mass, offset)| mass * offset * offset).sum::<f64>();
        Self {
            stiffness: hinge.stiffness * of_hinge + of_shaft,
            mass,
            damping_of_hinge: hinge.damping * of_hinge,
            of_shaft,
        }
    }
}

/// Displacements (m) of the centres of the links, from the base to the tip.
fn offsets(hinge_angle: f64, angles: &[f64], length: f64) -> Vec<f64> {
    let (mut slope, mut end) = (hinge_angle, 0.0);
    let next = |angle: &f64| {
        slope += angle;
        end += slope * length;
        end - slope * length / 2.0
    };
    angles.iter().map(next).collect()
}

/// Moments at the joints (N m), for forces at the centres of the links that are the masses times their displacements.
fn moments(masses: &[f64], offsets: &[f64], length: f64) -> Vec<f64> {
    let (mut force, mut moment) = (0.0, 0.0);
    let joint = |(mass, offset): (&f64, &f64)| {
        moment += force * length + mass * offset * length / 2.0;
        force += mass * offset;
        moment
    };
    let mut moments: Vec<_> = masses.iter().zip(offsets).rev().map(joint).collect();
    moments.reverse();
    moments
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::{Hinge, Rig, Shaft};

    fn whisker(shaft: Shaft, hinge: Hinge) -> Whisker {
        let [mut whisker, _] =
            <[Whisker; 2]>::try_from(Rig::default().whiskers).unwrap_or_else(|_| panic!("two whiskers"));
        (whisker.shaft, whisker.hinge) = (shaft, hinge);
        whisker
    }

    /// A hinge that does not move.
    fn clamp() -> Hinge {
        Hinge { stiffness: 1e9, damping: 0.0, armature: 0.0 }
    }

    #[test]
    fn a_clamped_wire_has_the_frequency_of_a_cantilever() {
        // The first root of cos x cosh x = -1 is 1.8751.
        for length in [0.05, 0.1, 0.14] {
            let shaft = Shaft { links: 64, length, ..Shaft::default() };
            let per_length = shaft.density * std::f64::consts::PI * shaft.radius * shaft.radius;
            let exact = math::square(1.875_104 / length) * (shaft.bending_stiffness() / per_length).sqrt();
            let found = Vibration::of(&whisker(shaft, clamp())).frequency;
            assert!((found / exact - 1.0).abs() < 1e-3, "{found} and {exact}");
        }
    }

    #[test]
    fn a_cone_has_the_frequency_of_kirchhoffs_solution() {
        // Kirchhoff (1879): 8.719 / L² √(E I / (ρ A)) for a cone, with I and A at the base.
        let shaft = Shaft { links: 256, tip_radius: Some(1e-7), ..Shaft::default() };
        let per_length = shaft.density * std::f64::consts::PI * shaft.radius * shaft.radius;
        let exact = 8.719 / (shaft.length * shaft.length) * (shaft.bending_stiffness() / per_length).sqrt();
        let found = Vibration::of(&whisker(shaft, clamp())).frequency;
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} and {exact}");
    }

    #[test]
    fn a_stiff_shaft_on_a_soft_hinge_is_a_rod() {
        let shaft = Shaft { links: 64, young_modulus: 1e18, ..Shaft::default() };
        let hinge = Hinge { stiffness: 1e-3, damping: 1e-6, armature: 2e-7 };
        let mass: f64 = (0..shaft.links).map(|link| shaft.link_mass(link)).sum();
        let inertia = mass * shaft.length * shaft.length / 3.0 + hinge.armature;
        let (frequency, decay) = ((hinge.stiffness / inertia).sqrt(), 2.0 * inertia / hinge.damping);
        let found = Vibration::of(&whisker(shaft, hinge));
        assert!((found.frequency / frequency - 1.0).abs() < 1e-3, "{found:?} and {frequency}");
        assert!((found.decay / decay - 1.0).abs() < 1e-3, "{found:?} and {decay}");
    }

    #[test]
    fn the_material_damps_a_clamped_shaft_by_the_square_of_its_frequency() {
        for length in [0.06, 0.1, 0.14] {
            let shaft = Shaft { length, ..Shaft::default() };
            let found = Vibration::of(&whisker(shaft.clone(), clamp()));
            let decay = 2.0 / (shaft.damping * found.frequency * found.frequency);
            assert!((found.decay / decay - 1.0).abs() < 1e-6, "{found:?} and {decay}");
        }
    }

    #[test]
    fn a_stated_mode_is_that_of_the_mechanics() {
        let shafts = [Shaft::default(), Shaft { tip_radius: Some(0.05e-3), length: 0.14, ..Shaft::default() }];
        for shaft in shafts {
            for (frequency, decay) in [(4.0, 0.004), (8.6, 0.3), (14.0, 3.0)] {
                let mut stated = whisker(shaft.clone(), Hinge::default());
                (stated.first_mode, stated.decay) = (Some(frequency), Some(decay));
                for found in [Vibration::of(&stated), Vibration::of(&stated.vibrating())] {
                    assert!((found.frequency / TAU / frequency - 1.0).abs() < 1e-9, "{found:?}");
                    assert!((found.decay / decay - 1.0).abs() < 1e-9, "{found:?}");
                }
            }
        }
    }

    #[test]
    fn a_frequency_alone_keeps_the_damping_of_the_material() {
        let mut slow = whisker(Shaft::default(), Hinge::default());
        slow.first_mode = Some(5.0);
        assert_eq!(slow.vibrating().shaft.damping.to_bits(), slow.shaft.damping.to_bits());
        slow.first_mode = None;
        assert_eq!(slow.vibrating(), slow);
    }

    #[test]
    fn a_released_whisker_comes_to_rest_with_the_slower_root_of_its_equation() {
        for frequency in [20.0, 50.0, 90.0] {
            for decay in [1e-3, 3e-3, 0.01, 0.03, 0.3, 3.0] {
                let vibration = Vibration { frequency, decay };
                let rate = vibration.relaxation().recip();
                // The amplitude obeys s² + 2 s / decay + frequency² = 0. Complex roots have the real part -1 / decay.
                let left = rate * rate - 2.0 * rate / decay + frequency * frequency;
                let is_creeping = decay * frequency < 1.0;
                assert!(
                    if is_creeping {
                        left.abs() < 1e-6 * frequency * frequency
                    } else {
                        (rate * decay - 1.0).abs() < 1e-12
                    },
                    "{vibration:?}"
                );
                assert!(!is_creeping || rate <= decay.recip(), "{vibration:?}");
            }
        }
    }

    #[test]
    fn without_damping_the_vibration_goes_on() {
        let shaft = Shaft { damping: 0.0, ..Shaft::default() };
        assert!(Vibration::of(&whisker(shaft, clamp())).decay.is_infinite());
    }
}
