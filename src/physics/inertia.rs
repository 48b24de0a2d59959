//! Inertia of the links of a shaft.

use vibrissa_runtime::rig::Shaft;

/// The least moment of inertia (kg m²) of a link that can be simulated: MuJoCo refuses smaller ones.
pub const LEAST_INERTIA: f64 = 1e-15;

/// The moment of inertia (kg m²) of a link about an axis across it, through its middle: that of a slender rod, `m l² / 12`.
///
/// The model has the same about every axis: a link turns about the vertical alone, and a thin wire's inertia about its own
/// axis would be below [`LEAST_INERTIA`].
#[must_use]
pub fn link_inertia(shaft: &Shaft, link: usize) -> f64 {
    shaft.link_mass(link) * shaft.link_length().powi(2) / 12.0
}
