//! A shaft followed from the force that bends it to its base.

use nalgebra::Vector2;

use super::extrapolation::integrate;

/// A force on a shaft, seen from where it is. Lengths are in units of the shaft's length `L`, forces of `EI / L²`, moments of
/// `EI / L`, with the bending stiffness `EI` at the base.
#[derive(Debug, Clone, Copy)]
pub(super) struct Load {
    /// Length of the shaft from the base to the force.
    pub(super) contact: f64,
    /// Direction of the force, counted from that of the shaft where the force is (rad).
    pub(super) angle: f64,
    /// Magnitude of the force.
    pub(super) force: f64,
}

/// A number with its derivatives by the parts of a [`Load`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Varied {
    pub(super) value: f64,
    pub(super) by_contact: f64,
    pub(super) by_angle: f64,
    pub(super) by_force: f64,
}

/// What a load makes of a shaft, in the frame of the shaft where the load is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shot {
    /// Direction of the shaft at the base (rad).
    pub(super) root: Varied,
    /// Bending moment at the base.
    pub(super) moment: Varied,
    /// Place of the base.
    pub(super) base: Vector2<f64>,
    /// Whether the shaft is bent to the left all along, but for where the load is.
    pub(super) bends_left: bool,
}

impl Shot {
    /// Solves the equations of the elastica, `θ' = M / EI` and `M' = −F sin(φ − θ)`, from the load to the base, with the
    /// variational equations for the derivatives, for a shaft whose radius at the tip is `taper` times that at the base.
    /// `None` if the load is not on the shaft, or absurdly great.
    pub(super) fn of(load: &Load, taper: f64) -> Option<Self> {
        let Load { contact, angle: psi, force } = *load;
        if !(contact > 0.0 && contact <= 1.0) {
            return None;
        }
        let slope = |t: f64, state: &[f64; 10]| {
            // 1 / EI at the length c (1 − t), and its derivative by c.
            let thickness = 1.0 + (taper - 1.0) * contact * (1.0 - t);
            let softness = thickness.powi(-4);
            let softness_c = 4.0 * (1.0 - taper) * (1.0 - t) * softness / thickness;
            // The direction and the moment, the place, and the derivatives of the first two by contact, angle and force.
            let [angle, moment, .., angle_c, moment_c, angle_a, moment_a, angle_f, moment_f] = *state;
            let (sin, cos) = angle.sin_cos();
            let (across, along) = (psi - angle).sin_cos();
            let turned = contact * force * along;
            [
                -contact * softness * moment,
                contact * force * across,
                -contact * cos,
                -contact * sin,
                -contact * softness * moment_c - (softness + contact * softness_c) * moment,
                force * across - turned * angle_c,
                -contact * softness * moment_a,
                turned * (1.0 - angle_a),
                -contact * softness * moment_f,
                contact * across - turned * angle_f,
            ]
        };
        let mut bends_left = true;
        let state = integrate([0.0; 10], slope, |state| bends_left &= state[1] > 0.0)?;
        let [angle, moment, x, y, angle_c, moment_c, angle_a, moment_a, angle_f, moment_f] = state;
        Some(Self {
            root: Varied { value: angle, by_contact: angle_c, by_angle: angle_a, by_force: angle_f },
            moment: Varied { value: moment, by_contact: moment_c, by_angle: moment_a, by_force: moment_f },
            base: Vector2::new(x, y),
            bends_left,
        })
    }
}
