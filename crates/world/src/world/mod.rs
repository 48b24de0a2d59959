//! The interface of the simulators: one command in, the samples of one control period out.

mod disturbed;
mod fault;
mod noise;
mod observed;
mod out_of_plane;
mod posture;
mod pruning;
mod sensors;
mod true_tips;

pub use disturbed::Disturbed;
pub use fault::Fault;
pub use observed::Observed;
pub use out_of_plane::OutOfPlane;
pub use posture::Posture;
pub use posture::raised;
pub use pruning::{Decision, Pruning, Verdict};
pub use sensors::{Sensors, whole};
pub use true_tips::with_true_tips;

use crate::geometry::Point2;
use vibrissa_runtime::signal::{Command, Sample};

/// A whisker snaps off if a part of it is faster than this (m/s) relative to its base.
pub const SNAP_OFF_SPEED: f64 = 0.1;

/// A simulation of a rig among solids. It may move to another thread.
pub trait World: Send {
    /// Simulates one control period under `command`. Returns the samples of that period, oldest first.
    ///
    /// # Errors
    /// [`Fault`] if the simulation can no longer be trusted. The run must end.
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault>;

    /// True if the platform's body touched an object during the last control period. No sensor reports this. It serves
    /// for scores, never for policies.
    fn body_touches(&self) -> bool;

    /// True if a whisker, by its index in the rig, snapped off during the last control period: a part of it was faster
    /// than 0.1 m/s relative to its base. No sensor reports this.
    fn snapped_off(&self, whisker: usize) -> bool;

    /// The motion of a whisker's tip out of the plane during the last control period. The whisker is given by its index
    /// in the rig. `None` in a planar world. No sensor reports this.
    fn out_of_plane(&self, _whisker: usize) -> Option<OutOfPlane> {
        None
    }

    /// The position of a whisker's tip at the newest sample (m, world frame). The whisker is given by its index in the
    /// rig. No sensor reports this.
    fn tip(&self, whisker: usize) -> Point2;

    /// The positions of platform and whiskers at the newest sample, for videos. `None` in a world without them. No sensor
    /// reports this.
    fn posture(&self) -> Option<Posture> {
        None
    }
}
