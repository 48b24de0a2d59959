//! The programs that publish for a robot.

use vibrissa_runtime::machine::Program;

use super::topic::Topic;

/// A program that publishes for a robot.
#[derive(Debug, Clone, Copy)]
pub enum Source<'p> {
    /// The whole loop, by this program of a policy.
    Loop(&'p Program),
    /// The sensor IO: buses, poses and actuator.
    SensorIo,
    /// The controller, by this program of a policy. Its samples are those of the sensor IO.
    Controller(&'p Program),
}

impl<'p> Source<'p> {
    /// The name that stands for the robot's in topics. That of the sensor IO is `NAME/sensor_io`, so that both services of a
    /// robot have their own status, health and faults.
    ///
    /// ```
    /// use vibrissa_robot::telemetry::{Source, Topic};
    /// let name = Source::SensorIo.name("array");
    /// assert_eq!(Topic::Health.of(&name), "vibrissa/array/sensor_io/health");
    /// ```
    #[must_use]
    pub fn name(self, robot: &str) -> String {
        match self {
            Self::Loop(_) | Self::Controller(_) => robot.to_owned(),
            Self::SensorIo => format!("{robot}/sensor_io"),
        }
    }

    /// The program of the policy, if there is one.
    #[must_use]
    pub fn program(self) -> Option<&'p Program> {
        match self {
            Self::Loop(program) | Self::Controller(program) => Some(program),
            Self::SensorIo => None,
        }
    }

    /// True if the program publishes messages of this topic.
    #[must_use]
    pub fn publishes(self, topic: Topic) -> bool {
        match self {
            Self::Loop(_) => true,
            Self::SensorIo => !matches!(topic, Topic::State | Topic::Perception),
            Self::Controller(_) => topic != Topic::Samples,
        }
    }
}
