//! What the rig's sensors report at one instant.

use crate::geometry::Pose;

/// The most whiskers that a rig can have; samples have room for this many, so that no loop allocates.
pub const MAX_WHISKERS: usize = 8;

/// What the rig's sensors report at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Pose of the platform's centre of mass in the world frame.
    pub body: Pose,
    /// One reading a whisker in the rig's order; those beyond the rig's whiskers stay at zero.
    pub whiskers: [Reading; MAX_WHISKERS],
}

/// One whisker's reading.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reading {
    /// Angle of the base hinge (rad), positive when the shaft has turned counter-clockwise.
    pub base_angle: f64,
    /// Force across the shaft at the base (N), as the shaft passes it on to the platform, positive to the shaft's left; where
    /// the rig measures it.
    pub shear: Option<f64>,
    /// Force along the shaft at the base (N), as the shaft passes it on to the platform, positive towards the tip; where the
    /// rig measures it.
    pub axial: Option<f64>,
}
