//! Whiskers to be bent.

use proptest::prelude::*;
use vibrissa_runtime::mechanics::{Elastica, ShaftShape};
use vibrissa_runtime::rig::{Rig, Whisker};

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

/// The same with thin ends: the radius at the tip is a tenth of that at the base or more.
pub(crate) fn any_tapered() -> impl Strategy<Value = Whisker> {
    (any(), prop_oneof![Just(1.0), 0.1..1.0_f64]).prop_map(|(mut whisker, taper)| {
        whisker.shaft.tip_radius = Some(taper * whisker.shaft.radius);
        whisker
    })
}

/// `EI / L` (N m).
pub(crate) fn moment_unit(whisker: &Whisker) -> f64 {
    whisker.shaft.bending_stiffness() / whisker.shaft.length
}

/// `EI / L²` (N).
pub(crate) fn force_unit(whisker: &Whisker) -> f64 {
    moment_unit(whisker) / whisker.shaft.length
}

/// A base moment (N m), given in units of `EI / L`, of as much less as the shaft tapers.
pub(crate) fn tip_moment(whisker: &Whisker, moment: f64) -> f64 {
    moment * whisker.shaft.tip_stiffness() / whisker.shaft.length
}

/// The shaft from the base to a share of its length.
pub(crate) fn cut(whisker: &Whisker, share: f64) -> Whisker {
    let mut whisker = whisker.clone();
    whisker.shaft.tip_radius = Some(whisker.shaft.radius_at(share));
    whisker.shaft.length *= share;
    whisker
}

/// The bend with a base moment as in [`tip_moment`] under a force in a direction (rad) at a length (m).
pub(crate) fn bent(whisker: &Whisker, contact_length: f64, moment: f64, direction: f64) -> Option<ShaftShape> {
    let elastica = Elastica::new(whisker);
    let base_angle = tip_moment(whisker, moment) / whisker.hinge.stiffness;
    elastica.solve_at(contact_length, base_angle, direction, &elastica.straight())
}
