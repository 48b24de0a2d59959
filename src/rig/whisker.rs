//! One whisker: where it sits, its shaft, and the spring at its base.

use nalgebra::Point2;

use super::{Hinge, Shaft};

/// One whisker: where it sits, its shaft, and the spring at its base.
#[derive(Debug, Clone, PartialEq)]
pub struct Whisker {
    /// The name by which policies bind to it.
    pub name: String,
    /// Where the base sits, in the body frame (m).
    pub base_body: Point2<f64>,
    /// Direction of the undeflected shaft in the body frame (rad, counter-clockwise from the heading).
    pub direction_body: f64,
    /// The shaft.
    pub shaft: Shaft,
    /// The base hinge, whose angle is the sensor's reading.
    pub hinge: Hinge,
}

impl Whisker {
    /// The reference whisker on one side of the reference platform: `side` is −1 for right, +1 for left.
    pub(super) fn reference(name: &str, side: f64) -> Self {
        Self {
            name: name.to_owned(),
            base_body: Point2::new(0.053, side * 0.030),
            direction_body: side * 105_f64.to_radians(),
            shaft: Shaft::default(),
            hinge: Hinge::default(),
        }
    }

    /// Which side of the platform the whisker points to: −1 for right, +1 for left.
    #[must_use]
    pub fn side(&self) -> f64 {
        if self.direction_body < 0.0 { -1.0 } else { 1.0 }
    }
}
