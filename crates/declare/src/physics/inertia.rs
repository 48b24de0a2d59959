//! Moments of inertia of the links of a shaft.

use vibrissa_runtime::math;
use vibrissa_runtime::rig::Shaft;

/// The smallest moment of inertia (kg m²) of a link. MuJoCo rejects smaller ones.
pub const MIN_INERTIA: f64 = 1e-15;

/// The largest share of a whisker's moment of inertia about its base that [`MIN_INERTIA`] may add. A frequency is inverse to the
/// root of an inertia, so the first mode changes by half a per cent at most.
const MAX_ADDED_SHARE: f64 = 0.01;

/// The moment of inertia (kg m²) of a link about a transverse axis through its centre. It is that of a slender rod,
/// `m l² / 12`, or [`MIN_INERTIA`] if that is greater.
///
/// The model uses the same value for all axes. A link rotates only about the vertical axis, and the axial moment of
/// inertia of a thin shaft would be below [`MIN_INERTIA`].
#[must_use]
pub fn link_inertia(shaft: &Shaft, link: usize) -> f64 {
    slender_rod(shaft, link).max(MIN_INERTIA)
}

/// The share of the moment of inertia of a whisker about its base that [`MIN_INERTIA`] adds, if it is too large for a
/// simulation of its dynamics.
#[must_use]
pub fn light_shaft(shaft: &Shaft) -> Option<f64> {
    let length = shaft.link_length();
    let about_base = |link: usize| {
        let centre = (link as f64 + 0.5) * length;
        slender_rod(shaft, link) + shaft.link_mass(link) * centre * centre
    };
    let added: f64 = (0..shaft.links).map(|link| link_inertia(shaft, link) - slender_rod(shaft, link)).sum();
    let share = added / (0..shaft.links).map(about_base).sum::<f64>();
    (share > MAX_ADDED_SHARE).then_some(share)
}

/// The moment of inertia (kg m²) of a link as a slender rod.
fn slender_rod(shaft: &Shaft, link: usize) -> f64 {
    shaft.link_mass(link) * math::square(shaft.link_length()) / 12.0
}
