//! Moments of inertia of the links of a shaft.

use vibrissa_runtime::rig::Shaft;

/// The smallest moment of inertia (kg m²) of a link. MuJoCo rejects smaller ones.
pub const MIN_INERTIA: f64 = 1e-15;

/// The moment of inertia (kg m²) of a link about a transverse axis through its centre. It is that of a slender rod,
/// `m l² / 12`.
///
/// The model uses the same value for all axes. A link rotates only about the vertical axis, and the axial moment of
/// inertia of a thin shaft would be below [`MIN_INERTIA`].
#[must_use]
pub fn link_inertia(shaft: &Shaft, link: usize) -> f64 {
    shaft.link_mass(link) * shaft.link_length().powi(2) / 12.0
}

/// The moment of inertia (kg m²) of a link that is too light for MuJoCo, if there is one.
#[must_use]
pub fn light_link(shaft: &Shaft) -> Option<f64> {
    (0..shaft.links).map(|link| link_inertia(shaft, link)).find(|&inertia| inertia < MIN_INERTIA)
}
