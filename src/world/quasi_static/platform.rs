//! The platform and its servos.

use crate::geometry::{Pose, Vector2};
use crate::rig::Platform;
use crate::signal::Command;

/// The platform and its servos.
#[derive(Debug)]
pub(super) struct Carriage {
    pub(super) pose: Pose,
    /// Velocity of the centre of mass (m/s, world frame), and yaw rate (rad/s).
    pub(super) velocity: Vector2,
    pub(super) yaw_rate: f64,
}

impl Carriage {
    pub(super) fn at_rest(pose: Pose) -> Self {
        Self { pose, velocity: Vector2::zeros(), yaw_rate: 0.0 }
    }

    /// What the velocity and the yaw rate are going to be after a time (s) under `command`, with a force (N) and a moment about
    /// the centre of mass (N m) that whiskers pass on. A servo of gain `k` on an inertia `J` follows with the time constant `J / k`,
    /// and a force keeps it from what is commanded by force over `k`.
    pub(super) fn aim(
        platform: &Platform,
        command: &Command,
        force: Vector2,
        moment: f64,
    ) -> (Vector2, f64) {
        let velocity = command.velocity_world + force * (platform.servo / platform.mass);
        (velocity, command.yaw_rate + moment * (platform.servo / platform.inertia))
    }

    /// Lets a time (s) pass in which the velocities go towards their aim with a time constant (s).
    pub(super) fn go(&mut self, (velocity, yaw_rate): (Vector2, f64), servo: f64, period: f64) {
        let left = (-period / servo).exp();
        // How long it would have to go at the difference to its aim.
        let behind = servo * (1.0 - left);
        self.pose.position += velocity * period + (self.velocity - velocity) * behind;
        self.pose.heading += yaw_rate * period + (self.yaw_rate - yaw_rate) * behind;
        self.velocity = velocity + (self.velocity - velocity) * left;
        self.yaw_rate = yaw_rate + (self.yaw_rate - yaw_rate) * left;
    }
}
