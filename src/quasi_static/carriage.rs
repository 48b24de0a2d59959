//! The platform as its servos move it.

use crate::geometry::{Pose, Vector2, perpendicular};
use crate::physics::Physics;
use vibrissa_runtime::rig::Platform;
use vibrissa_runtime::signal::Command;

use super::hull::Hull;
use super::surface::Surfaces;

/// The platform as its servos move it.
#[derive(Debug)]
pub(super) struct Carriage {
    pub(super) pose: Pose,
    speed: Twist,
    hull: Hull,
    platform: Platform,
    /// How deep (m) a body sinks in for a moment, for a speed (m/s) at which it runs into a solid.
    sinking: f64,
}

/// A motion in the plane, or its speed: of the centre of mass (m, world frame), and the turn about it (rad).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Twist {
    pub(super) along: Vector2,
    pub(super) turn: f64,
}

impl Twist {
    /// The same at a place that is `arm` (m, world frame) from the centre of mass.
    pub(super) fn at(&self, arm: Vector2) -> Vector2 {
        self.along + self.turn * perpendicular(arm)
    }

    fn blend(&self, other: &Self, own: f64, others: f64) -> Self {
        Self { along: own * self.along + others * other.along, turn: own * self.turn + others * other.turn }
    }
}

impl Carriage {
    pub(super) fn at_rest(pose: Pose, platform: &Platform, physics: &Physics) -> Self {
        // With most integrators MuJoCo takes no time constant below two steps. At critical damping what comes at v sinks in by v T / e.
        let time = physics.contact_time.max(2.0 * physics.step);
        Self {
            pose,
            speed: Twist::default(),
            hull: Hull::new(platform),
            platform: platform.clone(),
            sinking: time / std::f64::consts::E,
        }
    }

    /// Lets a time `period` (s) pass under `command`, with a force (N) and a moment about the centre of mass (N m) that whiskers
    /// pass on. How deep (m) the body would sink into what it touches, if it touches.
    ///
    /// A servo of gain `k` on an inertia `J` follows with the time constant `J / k`, and a force keeps it from what is commanded by
    /// force over `k`.
    pub(super) fn go(
        &mut self,
        command: &Command,
        (force, moment): (Vector2, f64),
        period: f64,
        surfaces: &Surfaces,
    ) -> Option<f64> {
        let Platform { servo, mass, inertia, .. } = self.platform;
        let aim = Twist {
            along: command.velocity_world + force * (servo / mass),
            turn: command.yaw_rate + moment * (servo / inertia),
        };
        let left = (-period / servo).exp();
        // For how long it would have to go at the difference to its aim.
        let behind = servo * (1.0 - left);
        let mut motion = self.speed.blend(&aim, behind, period - behind);
        let mut speed = self.speed.blend(&aim, left, 1.0 - left);
        let impact = self.hull.stop(self.pose, &mut motion, &mut speed, surfaces);
        self.pose.position += motion.along;
        self.pose.heading += motion.turn;
        self.speed = speed;
        impact.map(|speed| speed.max(0.0) * self.sinking)
    }
}
