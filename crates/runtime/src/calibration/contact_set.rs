//! A contact at a known position.

use std::f64::consts::PI;

use crate::geometry::Vector2;

/// The reading of a whisker during a contact at a known position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSet {
    /// Contact position on the surface (m, frame of the base: along the undeflected shaft, and to its left).
    pub contact_base: Vector2,
    /// Base angle (rad).
    pub base_angle: f64,
    /// Direction of the surface normal, towards the whisker (rad, frame of the base), if it is known.
    pub normal: Option<f64>,
    /// True for a contact of the shaft, false for a tip contact.
    pub on_shaft: bool,
}

impl ContactSet {
    /// Maximum number of contacts in a calibration. The time of a fit grows with the square of their number.
    pub const MOST: usize = 10_000;

    /// Returns the contact for a bend to the left: itself or its mirror image, with a normal from 0 to 2π.
    #[must_use]
    pub fn to_left(self) -> Self {
        let sign = if self.base_angle < 0.0 { -1.0 } else { 1.0 };
        let contact_base = Vector2::new(self.contact_base.x, sign * self.contact_base.y);
        let normal = self.normal.map(|normal| (sign * normal).rem_euclid(2.0 * PI));
        Self { contact_base, base_angle: sign * self.base_angle, normal, ..self }
    }
}
