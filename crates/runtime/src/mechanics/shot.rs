//! The shooting method for a shaft, from the force to the base.

use crate::math;

use super::extrapolation::integrate;

/// A force on a shaft. Lengths are in units of the shaft's length `L`, forces in units of `EI / L²`, and moments in
/// units of `EI / L`, with the bending stiffness `EI` at the base.
#[derive(Debug, Clone, Copy)]
pub(super) struct Load {
    /// Length of the shaft from the base to the force.
    pub(super) contact: f64,
    /// Direction of the force, counted from that of the shaft at the force (rad).
    pub(super) angle: f64,
    /// Magnitude of the force.
    pub(super) force: f64,
}

/// A number with its derivatives by the parts of a [`Load`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Varied {
    /// Value.
    pub(super) value: f64,
    /// Derivative by the length to the force.
    pub(super) by_contact: f64,
    /// Derivative by the angle of the force.
    pub(super) by_angle: f64,
    /// Derivative by the magnitude of the force.
    pub(super) by_force: f64,
}

/// The state of a shaft under a load. Positions are along and perpendicular to the force.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shot {
    /// Direction of the shaft at the base, counted from that at the force (rad).
    pub(super) root: Varied,
    /// Distance from the base to the force, in the direction of the force.
    pub(super) along: Varied,
    /// Lever of the force about the base: its distance to the right of the base, seen in the direction of the force.
    pub(super) lever: Varied,
    /// Bending moment at the base.
    pub(super) moment: Varied,
    /// True if the shaft is bent to the left everywhere, except at the force.
    pub(super) bends_left: bool,
}

impl Shot {
    /// Integrates the equations of the elastica from the force to the base, with the variational equations for the
    /// derivatives. They are `θ' = M / EI` with the moment `M = F λ` and the lever `λ' = −sin(φ − θ)`. `taper` is the
    /// ratio of the radii at the tip and at the base. `None` if the force is not on the shaft, or much too large.
    pub(super) fn of(load: &Load, taper: f64) -> Option<Self> {
        let Load { contact, angle: psi, force } = *load;
        if !(contact > 0.0 && contact <= 1.0) {
            return None;
        }
        let slope = |t: f64, state: &[f64; 12]| {
            // 1 / EI at the length c (1 − t), and its derivative by c.
            let thickness = 1.0 + (taper - 1.0) * contact * (1.0 - t);
            let softness = math::powi(thickness, -4);
            let softness_c = 4.0 * (1.0 - taper) * (1.0 - t) * softness / thickness;
            // Direction, lever and distance, and their derivatives by contact, angle and force.
            let [angle, lever, _, angle_c, lever_c, _, angle_a, lever_a, _, angle_f, lever_f, _] = *state;
            let (across, along) = math::sin_cos(psi - angle);
            let (across_c, along_c) = (contact * across, contact * along);
            let curvature = contact * softness * force;
            [
                -curvature * lever,
                across_c,
                along_c,
                -curvature * lever_c - force * (softness + contact * softness_c) * lever,
                across - along_c * angle_c,
                along + across_c * angle_c,
                -curvature * lever_a,
                along_c * (1.0 - angle_a),
                -across_c * (1.0 - angle_a),
                -curvature * lever_f - contact * softness * lever,
                -along_c * angle_f,
                across_c * angle_f,
            ]
        };
        let mut bends_left = true;
        let state = integrate([0.0; 12], slope, |state| bends_left &= state[1] > 0.0)?;
        let varied = |i: usize| Varied {
            value: state[i],
            by_contact: state[3 + i],
            by_angle: state[6 + i],
            by_force: state[9 + i],
        };
        let lever = varied(1);
        let moment = Varied {
            value: force * lever.value,
            by_contact: force * lever.by_contact,
            by_angle: force * lever.by_angle,
            by_force: lever.value + force * lever.by_force,
        };
        Some(Self { root: varied(0), along: varied(2), lever, moment, bends_left })
    }
}
