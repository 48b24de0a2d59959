//! The shape of a bent shaft.

use nalgebra::Vector2;

/// The equilibrium of a whisker's shaft under a force at one point.
///
/// The frame is that of the whisker's base: origin at the base, first axis along the undeflected shaft, second axis to
/// its left. Positions are those of the shaft's axis. The contact is one radius away, against the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShaftShape {
    /// Base angle (rad).
    pub base_angle: f64,
    /// Shear: force perpendicular to the shaft at the base (N), positive to the left of the bent shaft.
    pub shear: f64,
    /// Axial force at the base (N), positive towards the tip.
    pub axial: f64,
    /// Length of the shaft from the base to the force (m).
    pub contact_length: f64,
    /// Position of the force (m).
    pub contact_base: Vector2<f64>,
    /// Magnitude of the force (N).
    pub force: f64,
    /// Direction of the force (rad).
    pub force_direction: f64,
    /// Position of the tip's centre (m).
    pub tip_base: Vector2<f64>,
    /// Direction of the shaft from the force to the tip (rad).
    pub tip_angle: f64,
}

impl ShaftShape {
    /// The mirror image, bent to the other side.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |position: Vector2<f64>| Vector2::new(position.x, -position.y);
        Self {
            base_angle: -self.base_angle,
            shear: -self.shear,
            contact_base: mirror(self.contact_base),
            force_direction: -self.force_direction,
            tip_base: mirror(self.tip_base),
            tip_angle: -self.tip_angle,
            ..*self
        }
    }
}
