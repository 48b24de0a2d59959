//! Worlds that a loop can drive: advance by a command, give the samples of one control tick.

mod fault;
#[cfg(feature = "sim")]
mod mujoco;
mod quasi_static;
mod sensors;

pub use fault::Fault;
#[cfg(feature = "sim")]
pub use mujoco::{MujocoError, MujocoWorld, engine_version};
pub use quasi_static::{QuasiStaticError, QuasiStaticWorld};
pub(crate) use sensors::Sensors;

use crate::signal::{Command, Sample};

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
}
