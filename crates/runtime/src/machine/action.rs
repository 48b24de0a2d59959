//! The action of a tick.

use crate::geometry::Vector2;

/// The motion that a policy requests in a tick. [`Steering`](crate::motion::Steering) converts it to a command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Keep the last command. After [`Stop`](Self::Stop), continue to hold the pose.
    Hold,
    /// Stop the platform and hold its pose.
    Stop,
    /// Move the body or the base of a whisker in a direction.
    Steer {
        /// The point that moves.
        mover: Mover,
        /// Direction of the motion in the world frame. Its length is ignored. A zero vector means no motion.
        along_world: Vector2,
        /// Speed (m/s).
        speed: f64,
        /// The rotation during the motion.
        turn: Turn,
    },
}

/// The point that a steering action moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mover {
    /// The platform's centre of mass.
    Body,
    /// The base of the whisker with this index. The body moves at the given speed. Its direction is chosen so that the
    /// base moves along.
    Whisker(usize),
}

/// The rotation of the platform during a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// Rotate to this heading (rad, world frame) with the yaw controller of the rig.
    Facing(f64),
    /// Rotate at this yaw rate (rad/s, counter-clockwise positive).
    Rate(f64),
}

/// A number of an action that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NonFinite {
    /// The part of the action that contains the number.
    pub part: ActionPart,
    /// True if it is NaN, false if it is infinite.
    pub is_nan: bool,
}

/// A number or a vector of an action.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ActionPart {
    /// The direction of the motion.
    #[error("the direction behind `along`")]
    Along,
    /// The speed.
    #[error("the speed behind `at`")]
    Speed,
    /// The heading to which the platform rotates.
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
    /// Returns the first number of the action that is not finite, in the order of the policy's text.
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

    /// True if every number of the action is finite.
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
