//! The motion of the platform under its servos.

use crate::geometry::{Pose, Vector2, perpendicular};
use crate::physics::Physics;
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Platform;
use vibrissa_runtime::signal::Command;

use super::footprint::Footprint;
use super::surface::Surfaces;

/// The dynamic state of the platform.
#[derive(Debug)]
pub(super) struct PlatformDynamics {
    pub(super) pose: Pose,
    velocity: Twist,
    footprint: Footprint,
    platform: Platform,
    /// The transient penetration depth (m) per impact speed (m/s).
    depth_per_speed: f64,
}

/// A planar displacement or velocity: of the centre of mass (m or m/s, world frame), and the rotation about it (rad or
/// rad/s).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Twist {
    pub(super) linear: Vector2,
    pub(super) angular: f64,
}

impl Twist {
    /// Returns the linear part at a point with the offset `arm` (m, world frame) from the centre of mass.
    pub(super) fn at(&self, arm: Vector2) -> Vector2 {
        self.linear + self.angular * perpendicular(arm)
    }

    /// A weighted sum, with the weights of the linear and of the angular part.
    fn blend(&self, other: &Self, own: [f64; 2], others: [f64; 2]) -> Self {
        Self {
            linear: own[0] * self.linear + others[0] * other.linear,
            angular: own[1] * self.angular + others[1] * other.angular,
        }
    }
}

impl PlatformDynamics {
    pub(super) fn at_rest(pose: Pose, platform: &Platform, physics: &Physics) -> Self {
        // Most integrators of MuJoCo limit the time constant `T` to at least two steps. A critically damped contact at
        // the speed `v` has the maximum depth `v T / e`.
        let time = physics.contact_time.max(2.0 * physics.step);
        Self {
            pose,
            velocity: Twist::default(),
            footprint: Footprint::new(platform),
            platform: platform.clone(),
            depth_per_speed: time / std::f64::consts::E,
        }
    }

    /// Advances the platform by `period` (s) under `command`. The whiskers exert a force (N) and a moment about the
    /// centre of mass (N m). Returns the penetration depth of the body (m), or `None` without contact.
    ///
    /// A servo with the gain `k` moves the inertia `J` with the time constant `J / k`. A force causes the velocity
    /// error `force / k`.
    pub(super) fn step(
        &mut self,
        command: &Command,
        (force, moment): (Vector2, f64),
        period: f64,
        surfaces: &Surfaces,
    ) -> Option<f64> {
        let Platform { mass, inertia, .. } = self.platform;
        let servos = self.platform.servos();
        let (servo, yaw_servo) = (servos.x, servos.z);
        let target = Twist {
            linear: command.velocity_world + force * (servo / mass),
            angular: command.yaw_rate + moment * (yaw_servo / inertia),
        };
        let remaining = [servo, yaw_servo].map(|servo| math::exp(-period / servo));
        // The time integral of the decaying difference to the target velocity.
        let transient = [servo * (1.0 - remaining[0]), yaw_servo * (1.0 - remaining[1])];
        let mut motion = self.velocity.blend(&target, transient, transient.map(|transient| period - transient));
        let mut velocity = self.velocity.blend(&target, remaining, remaining.map(|remaining| 1.0 - remaining));
        let impact = self.footprint.constrain(self.pose, &mut motion, &mut velocity, surfaces);
        self.pose.position += motion.linear;
        self.pose.heading += motion.angular;
        self.velocity = velocity;
        impact.map(|speed| speed.max(0.0) * self.depth_per_speed)
    }
}
