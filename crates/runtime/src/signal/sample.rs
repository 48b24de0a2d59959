//! The samples of the rig's sensors.

use crate::geometry::{Point2, Pose};

/// Maximum number of whiskers of a rig. Samples have a fixed size, so that no loop allocates memory.
pub const MAX_WHISKERS: usize = 8;

/// The readings of the rig's sensors at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Pose of the platform's centre of mass in the world frame.
    pub body: Pose,
    /// One reading per whisker in the order of the rig. Further entries are zero.
    pub whiskers: [Reading; MAX_WHISKERS],
}

/// The reading of one whisker.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reading {
    /// Base angle (rad), counter-clockwise positive.
    pub base_angle: f64,
    /// Shear (N): the force perpendicular to the undeflected shaft that it exerts on the platform, positive to its
    /// left. `None` if the rig does not measure it.
    pub shear: Option<f64>,
    /// Axial force (N): the force along the undeflected shaft that it exerts on the platform, positive towards the tip.
    /// `None` if the rig does not measure it.
    pub axial: Option<f64>,
    /// The true tip, for the contact estimator `truth`. Only a simulator can supply it, and only for a run that asks for
    /// it. Otherwise it is `None`.
    pub true_tip: Option<TrueTip>,
}

/// The true tip of a whisker in a simulator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueTip {
    /// The point of the tip that is nearest to a surface (m, world frame).
    pub point_world: Point2,
    /// True if this point touches the surface.
    pub touches: bool,
}
