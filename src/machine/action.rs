//! What a tick asks the platform to do.

use crate::geometry::Vector2;

/// What a tick asks the platform to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Keep to the last command.
    Hold,
    /// Stand still.
    Stop,
    /// Move the body, or one whisker's base, in a direction.
    Steer {
        /// What is to move.
        mover: Mover,
        /// Direction of the motion in the world frame; its length does not matter, and zero stands still.
        along_world: Vector2,
        /// Speed (m/s).
        speed: f64,
        /// How to turn meanwhile.
        turn: Turn,
    },
}

/// What a steering action moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mover {
    /// The platform's centre of mass.
    Body,
    /// The base of the whisker with this index: the body moves at the speed, in the direction that takes the base along.
    Whisker(usize),
}

/// How the platform turns while it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// Towards this heading (rad, world frame), by the rig's yaw controller.
    Facing(f64),
    /// At this rate (rad/s, counter-clockwise positive).
    Rate(f64),
}

impl Action {
    /// Whether every number in the action is finite.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match *self {
            Self::Hold | Self::Stop => true,
            Self::Steer { along_world, speed, turn: Turn::Facing(angle) | Turn::Rate(angle), .. } => {
                along_world.x.is_finite() && along_world.y.is_finite() && speed.is_finite() && angle.is_finite()
            }
        }
    }
}
