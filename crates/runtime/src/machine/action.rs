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

/// A number of a command that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NonFinite {
    /// Which number it is.
    pub part: ActionPart,
    /// Whether it is no number at all; otherwise it is infinite.
    pub is_nan: bool,
}

/// A number, or vector, of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ActionPart {
    /// The direction of the motion.
    #[error("the direction behind `along`")]
    Along,
    /// The speed.
    #[error("the speed behind `at`")]
    Speed,
    /// The heading to turn to.
    #[error("the heading behind `facing`")]
    Heading,
    /// The yaw rate.
    #[error("the yaw rate behind `turning`")]
    YawRate,
}

impl std::fmt::Display for NonFinite {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.part, if self.is_nan { "is not a number" } else { "is infinite" })
    }
}

impl Action {
    /// The first number in the action, as it is written, that is not finite.
    #[must_use]
    pub fn non_finite(&self) -> Option<NonFinite> {
        let Self::Steer { along_world: along, speed, turn, .. } = *self else { return None };
        let (turn, turned) = match turn {
            Turn::Facing(heading) => (heading, ActionPart::Heading),
            Turn::Rate(rate) => (rate, ActionPart::YawRate),
        };
        let numbers =
            [(ActionPart::Along, along.x), (ActionPart::Along, along.y), (ActionPart::Speed, speed), (turned, turn)];
        let (part, number) = numbers.into_iter().find(|(_, number)| !number.is_finite())?;
        Some(NonFinite { part, is_nan: number.is_nan() })
    }

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
