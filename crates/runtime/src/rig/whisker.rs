//! A whisker: its mounting, shaft and base hinge.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use super::{Hinge, Sensing, Shaft};
use crate::calibration::Calibration;
use crate::geometry::{Pose, coordinates};

/// A whisker: its mounting, shaft and base hinge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Whisker {
    /// The name by which policies bind the whisker.
    pub name: String,
    /// Position of the base in the body frame (m).
    #[serde(with = "coordinates")]
    pub base_body: Point2<f64>,
    /// Direction of the undeflected shaft in the body frame (rad, counter-clockwise from the heading).
    pub direction_body: f64,
    /// Angle of the undeflected shaft above the plane of motion (rad). Only a spatial simulation uses it. Perception is
    /// planar.
    pub pitch: f64,
    /// The shaft.
    pub shaft: Shaft,
    /// The base hinge. Its angle is the main reading of the sensor.
    pub hinge: Hinge,
    /// Frequency (Hz) of the first mode of the free whisker, without damping. `None` for that of its mechanics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_mode: Option<f64>,
    /// Time (s) in which the amplitude of this mode decreases to 1/e. `None` for that of its mechanics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decay: Option<f64>,
    /// Measured properties that perception uses instead of those above.
    pub calibration: Option<Calibration>,
}

impl Whisker {
    /// The reference whisker on one side of the reference platform. `side` is −1 for right, +1 for left.
    pub(super) fn reference(name: &str, side: f64) -> Self {
        Self {
            name: name.to_owned(),
            base_body: Point2::new(0.053, side * 0.030),
            direction_body: side * 105_f64.to_radians(),
            pitch: 0.0,
            shaft: Shaft::default(),
            hinge: Hinge::default(),
            first_mode: None,
            decay: None,
            calibration: None,
        }
    }

    /// A substitute for a whisker that a policy binds and a rig lacks: the reference whisker at the centre of mass,
    /// along the heading.
    #[must_use]
    pub fn unfitted() -> Self {
        Self { base_body: Point2::origin(), direction_body: 0.0, ..Self::reference("", 1.0) }
    }

    /// Ratio of the base angles of this whisker and of the reference whisker, bent to the same shape. The base angle of a
    /// shape is proportional to `E I / (k L)`, with the bending stiffness `E I` of the shaft, its length `L`, and the
    /// stiffness `k` of the hinge.
    #[must_use]
    pub fn flexibility(&self) -> f64 {
        let angle = |whisker: &Self| whisker.shaft.tip_stiffness() / (whisker.hinge.stiffness * whisker.shaft.length);
        angle(self) / angle(&Self::reference("", 1.0))
    }

    /// The whisker as perception models it: with the measured stiffness of the base hinge, or with all measured
    /// properties, as far as there are some.
    #[must_use]
    pub fn perceived(&self) -> Self {
        let mut whisker = self.clone();
        if let Some(calibration) = &self.calibration {
            if let Some(stiffness) = calibration.hinge_stiffness {
                whisker.hinge.stiffness = stiffness;
            }
            if let Some(measured) = &calibration.measured {
                measured.apply(&mut whisker);
            }
            if let Some(motion) = &calibration.free_motion {
                motion.apply(&mut whisker);
            }
        }
        whisker
    }

    /// The coefficient of friction that perception assumes: that of the rig, or the one that a calibration has measured.
    #[must_use]
    pub fn friction(&self, sensing: &Sensing) -> f64 {
        let measured = self.calibration.as_ref().and_then(|calibration| calibration.measured.as_ref());
        match measured {
            Some(measured) if sensing.estimation.friction && sensing.friction == 0.0 => measured.friction,
            _ => sensing.friction,
        }
    }

    /// A whisker whose bends to the left are the mirror images of this one's bends to the right.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut whisker = self.clone();
        whisker.shaft.curvature = -self.shaft.curvature;
        whisker
    }

    /// Pose of the base in the body frame. Its heading is the direction of the undeflected shaft.
    #[must_use]
    pub fn base_pose(&self) -> Pose {
        Pose { position: self.base_body, heading: self.direction_body }
    }

    /// Direction (rad, frame of the base) of the normal of a surface that a policy follows, for a bend to the left. The
    /// whisker trails along it. One that is swept back does so with the body parallel to the surface. One that points
    /// forward does so with the body turned towards the surface by twice that angle. Equal angles forward and back are
    /// then equal angles to the surface.
    #[must_use]
    pub fn usual_normal(&self) -> f64 {
        PI - (self.direction_body.abs() - FRAC_PI_2).abs()
    }

    /// Side of the platform to which the whisker points: −1 for right, +1 for left.
    #[must_use]
    pub fn side(&self) -> f64 {
        if self.direction_body < 0.0 { -1.0 } else { 1.0 }
    }
}
