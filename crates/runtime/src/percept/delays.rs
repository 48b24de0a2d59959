//! The measured delays of poses and commands.

use crate::geometry::Pose;
use crate::rig::Rig;
use crate::signal::{Command, Sample};

use super::platform_motion::{Motion, PlatformMotion};
use super::pose_delay::{Misfit, PoseDelay};

/// The delays of poses and commands, and the poses without them.
///
/// Commands and poses give the sum of both delays. Contacts give the delay of poses alone.
#[derive(Debug, Clone)]
pub(super) struct Delays {
    platform: PlatformMotion,
    contacts: PoseDelay,
    /// Delay (s) of poses that is corrected.
    pose: f64,
    /// Share of a difference by which the corrected delay follows the measured one in a tick.
    following: f64,
}

/// Time (s) in which the corrected delay follows the measured one.
const FOLLOWING: f64 = 1.0;

impl Delays {
    /// Creates the measurement for `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        let following = (FOLLOWING * rig.sensing.control_rate).recip().min(1.0);
        Self { platform: PlatformMotion::new(rig), contacts: PoseDelay::new(), pose: 0.0, following }
    }

    /// Sets the command that holds until the next tick.
    pub(super) fn command(&mut self, command: Command) {
        self.platform.command(command);
    }

    /// Begins a tick `period` (s) after the last one.
    pub(super) fn begin(&mut self, period: f64) {
        self.platform.advance(period);
    }

    /// The pose at the time of a sample, which is `ago` (s) before the end of the tick. The measured pose is older by
    /// the delay of poses.
    pub(super) fn pose(&self, sample: &Sample, ago: f64) -> Pose {
        if self.pose > 0.0 {
            let until = ago + self.platform.delay() - self.pose;
            moved(sample.body, &self.platform.between(until + self.pose, until))
        } else {
            sample.body
        }
    }

    /// Adds the misfit of a reading.
    pub(super) fn add(&mut self, misfit: &Misfit) {
        self.contacts.add(misfit, self.pose);
    }

    /// Ends a tick with the measured `pose`, which may be unknown.
    pub(super) fn end(&mut self, pose: Pose) {
        self.platform.compare(pose);
        let measured = self.contacts.value(self.platform.delay());
        self.pose += (measured - self.pose) * self.following;
    }

    /// The pose at which the next command takes effect, from the measured `pose`.
    pub(super) fn at_effect(&self, pose: Pose) -> Pose {
        let delay = self.platform.delay();
        if delay > 0.0 { moved(pose, &self.platform.between(delay, 0.0)) } else { pose }
    }

    /// Time constant (s) of the servos.
    pub(super) fn servo(&self) -> f64 {
        self.platform.servo()
    }

    /// The expected motion in the tick that ends with the newest measured pose.
    pub(super) fn expected(&self, period: f64) -> Motion {
        let delay = self.platform.delay();
        self.platform.between(delay + period, delay)
    }
}

/// A pose after a motion.
fn moved(pose: Pose, motion: &Motion) -> Pose {
    Pose { position: pose.position + motion.xy(), heading: pose.heading + motion.z }
}
