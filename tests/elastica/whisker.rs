//! Whiskers to be bent.

use proptest::prelude::*;
use vibrissa::mechanics::{Bend, Elastica};
use vibrissa::rig::{Rig, Whisker};

/// A whisker whose hinge is `ratio` times as stiff as its shaft, `EI / L`.
pub(crate) fn with_ratio(length: f64, radius: f64, ratio: f64) -> Whisker {
    let mut whisker = Rig::default().whiskers.remove(1);
    (whisker.shaft.length, whisker.shaft.radius) = (length, radius);
    whisker.hinge.stiffness = ratio * moment_unit(&whisker);
    whisker
}

/// Whiskers of any sensible size on soft and stiff hinges.
pub(crate) fn any() -> impl Strategy<Value = Whisker> {
    (0.02..0.3_f64, 0.03e-3..1e-3_f64, 0.5..6.0_f64)
        .prop_map(|(length, radius, exponent)| with_ratio(length, radius, 10_f64.powf(exponent)))
}

/// `EI / L` (N m).
pub(crate) fn moment_unit(whisker: &Whisker) -> f64 {
    whisker.shaft.bending_stiffness() / whisker.shaft.length
}

/// `EI / L²` (N).
pub(crate) fn force_unit(whisker: &Whisker) -> f64 {
    moment_unit(whisker) / whisker.shaft.length
}

/// The bend with a base moment, in units of `EI / L`, under a force in a direction (rad) at a length (m).
pub(crate) fn bent(whisker: &Whisker, contact_length: f64, moment: f64, direction: f64) -> Option<Bend> {
    let elastica = Elastica::new(whisker);
    let base_angle = moment * moment_unit(whisker) / whisker.hinge.stiffness;
    elastica.solve_at(contact_length, base_angle, direction, &elastica.straight())
}
