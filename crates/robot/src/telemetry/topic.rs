//! The topics.

/// A topic of a robot. Its name is `vibrissa/NAME/` and a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Topic {
    /// `online`, or `offline` once the program has ended or is lost. This payload is plain text.
    Status,
    /// [`State`](super::State).
    State,
    /// [`Health`](super::Health).
    Health,
    /// [`Samples`](super::Samples).
    Samples,
    /// [`Perception`](super::Perception).
    Perception,
    /// [`CommandLog`](super::CommandLog).
    CommandLog,
    /// [`FaultNote`](super::FaultNote).
    Events,
    /// [`Latency`](super::Latency).
    Latency,
    /// [`Dropped`](super::Dropped).
    Dropped,
    /// To the actuator: [`CommandPacket`](crate::link::CommandPacket).
    Command,
    /// From the actuator: the acknowledgement of a command.
    Acknowledged,
    /// From the localisation: [`PosePacket`](crate::link::PosePacket).
    Pose,
    /// From the sensor IO to the controller: all inputs of a control step.
    Inputs,
}

impl Topic {
    /// All topics.
    pub const ALL: [Self; 13] = [
        Self::Status,
        Self::State,
        Self::Health,
        Self::Samples,
        Self::Perception,
        Self::CommandLog,
        Self::Events,
        Self::Latency,
        Self::Dropped,
        Self::Command,
        Self::Acknowledged,
        Self::Pose,
        Self::Inputs,
    ];

    /// The last word of the topic.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Status => "status",
            Self::State => "state",
            Self::Health => "health",
            Self::Samples => "samples",
            Self::Perception => "perception",
            Self::CommandLog => "command_log",
            Self::Events => "events",
            Self::Latency => "latency",
            Self::Dropped => "dropped",
            Self::Command => "command",
            Self::Acknowledged => "acknowledged",
            Self::Pose => "pose",
            Self::Inputs => "inputs",
        }
    }

    /// The topic of the robot with this name.
    ///
    /// ```
    /// use vibrissa_robot::telemetry::Topic;
    /// assert_eq!(Topic::CommandLog.of("array"), "vibrissa/array/command_log");
    /// ```
    #[must_use]
    pub fn of(self, robot: &str) -> String {
        format!("vibrissa/{robot}/{}", self.word())
    }

    /// True if the broker keeps the last message for later subscribers.
    #[must_use]
    pub fn is_retained(self) -> bool {
        matches!(self, Self::Status | Self::State | Self::Health)
    }
}
