//! The measured delays and errors of poses and commands.

use nalgebra::Vector3;

use crate::geometry::Pose;
use crate::math;
use crate::rig::{Estimation, Rig};
use crate::signal::{Command, Sample};

use super::command_delay::CommandDelay;
use super::inertia::Acceleration;
use super::platform_motion::{Motion, PlatformMotion};
use super::pose_delay::{Misfit, PoseDelay};
use super::pose_noise::{PoseDeviation, PoseNoise};

/// The delays of poses and commands, and the poses without them.
///
/// Commands and poses give the sum of both delays, and the errors of poses. Contacts give the delay of poses alone, and the
/// inertia of whiskers in free air that of commands.
#[derive(Debug, Clone)]
pub(super) struct Motions {
    platform: PlatformMotion,
    contacts: PoseDelay,
    commands: CommandDelay,
    noise: PoseNoise,
    /// Heading (rad) of the last measured pose, or NaN.
    heading: f64,
    /// Delay (s) of poses that is corrected.
    pose: f64,
    /// What is corrected.
    estimation: Estimation,
    /// Share of a difference by which the corrected delay follows the measured one in a tick.
    following: f64,
}

/// Time (s) in which the corrected delay follows the measured one.
const FOLLOWING: f64 = 1.0;

impl Motions {
    /// Creates the measurement for `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        let following = math::min((FOLLOWING * rig.sensing.control_rate).recip(), 1.0);
        Self {
            platform: PlatformMotion::new(rig),
            contacts: PoseDelay::new(),
            commands: CommandDelay::new(),
            noise: PoseNoise::new(),
            heading: f64::NAN,
            pose: 0.0,
            estimation: rig.sensing.estimation,
            following,
        }
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
            let until = ago + self.delay() - self.pose;
            moved(sample.body, &self.platform.between(until + self.pose, until))
        } else {
            sample.body
        }
    }

    /// Adds the misfit of a reading.
    pub(super) fn add(&mut self, misfit: &Misfit) {
        self.contacts.add(misfit, self.pose);
    }

    /// Adds the mean reading (rad) of a whisker in free air without its offset, and its standard deviation (rad). `bent` is
    /// its base angle (rad) on a platform that accelerates.
    pub(super) fn add_free(&mut self, reading: f64, deviation: f64, bent: impl Fn(&Acceleration) -> f64) {
        let heading = self.heading;
        if self.delay() > 0.0 && self.platform.is_settled() && heading.is_finite() {
            let platform = &self.platform;
            self.commands.add(reading, deviation, |delay| bent(&Acceleration::of(platform.speed(delay), heading)));
        }
    }

    /// Ends a tick with the measured `pose`, which may be unknown.
    pub(super) fn end(&mut self, pose: Pose) {
        let difference = self.platform.compare(pose);
        self.noise.take(difference);
        self.heading = pose.heading;
        let total = self.delay();
        let measured = self.contacts.value(total, |delay| self.commands.cost(total - delay));
        self.pose += (measured - self.pose) * self.following;
    }

    /// The pose at which the next command takes effect, from the measured `pose`.
    pub(super) fn at_effect(&self, pose: Pose) -> Pose {
        let delay = self.delay();
        if delay > 0.0 { moved(pose, &self.platform.between(delay, 0.0)) } else { pose }
    }

    /// The errors of measured poses.
    pub(super) fn pose_deviation(&self) -> PoseDeviation {
        if self.estimation.pose_noise { self.noise.deviation() } else { PoseDeviation::default() }
    }

    /// Measured time constants (s) of the servos: x, y, yaw. `None` if they are those of the rig.
    pub(super) fn servos(&self) -> Option<Vector3<f64>> {
        self.platform.servos().filter(|_| self.estimation.delay)
    }

    /// Delay (s) of a measured pose behind its command.
    fn delay(&self) -> f64 {
        if self.estimation.delay { self.platform.delay() } else { 0.0 }
    }

    /// The expected motion in the tick of `period` (s) that ends with the newest measured pose. `None` if it is as the
    /// rig states.
    pub(super) fn expected(&self, period: f64) -> Option<Motion> {
        let delay = self.delay();
        let is_as_stated = delay == 0.0 && self.servos().is_none();
        (!is_as_stated).then(|| self.platform.between(delay + period, delay))
    }
}

/// A pose after a motion.
fn moved(pose: Pose, motion: &Motion) -> Pose {
    Pose { position: pose.position + motion.xy(), heading: pose.heading + motion.z }
}
