//! Worlds that a loop can drive: advance by a command, give the samples of one control tick.

mod fault;
mod sensors;

pub use fault::Fault;
pub(crate) use sensors::{Sensors, whole};

use crate::geometry::Point2;
use vibrissa_runtime::signal::{Command, Sample};

/// A whisker of which something moves faster than this (m/s) against its base springs: it has slipped off what bent it.
pub(crate) const SPRINGING: f64 = 0.1;

/// A world with a rig in it.
pub trait World {
    /// Lets one control period pass under `command` and returns the samples that the sensors took during it, oldest first.
    ///
    /// # Errors
    /// [`Fault`] when the world can no longer be trusted; the run must end.
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault>;

    /// Whether the platform's body touched something during the last control period. No sensor reports this: it is for
    /// scores, never for policies.
    fn body_touches(&self) -> bool;

    /// Whether a whisker, by its index in the rig, sprang during the last control period, as one does that slips off a corner:
    /// something of it was faster than 0.1 m/s against its base. No sensor reports this either.
    fn springs(&self, whisker: usize) -> bool;

    /// Where the end of a whisker, by its index in the rig, is at the newest sample (m, world frame). No sensor reports this either.
    fn tip(&self, whisker: usize) -> Point2;
}
