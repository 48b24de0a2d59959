//! The command to the platform.

use crate::geometry::Vector2;

/// The velocities that the platform's servos follow until the next command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// Velocity of the platform's centre of mass in the world frame (m/s).
    pub velocity_world: Vector2,
    /// Yaw rate (rad/s, counter-clockwise positive).
    pub yaw_rate: f64,
}

impl Command {
    /// The command to stand still.
    pub const STOP: Self = Self { velocity_world: Vector2::new(0.0, 0.0), yaw_rate: 0.0 };

    /// True if every component is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.velocity_world.x.is_finite() && self.velocity_world.y.is_finite() && self.yaw_rate.is_finite()
    }
}
