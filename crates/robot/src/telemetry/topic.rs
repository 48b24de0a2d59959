//! The topics.

vibrissa_runtime::kinds! {
    /// A topic of a robot. Its name is `vibrissa/NAME/` and a word.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Topic,
    /// The last word of the topic.
    fn word {
        /// `online`, or `offline` once the program has ended or is lost. This payload is plain text.
        Status = "status",
        /// [`State`](super::State).
        State = "state",
        /// [`Health`](super::Health).
        Health = "health",
        /// [`Samples`](super::Samples).
        Samples = "samples",
        /// [`Perception`](super::Perception).
        Perception = "perception",
        /// [`CommandLog`](super::CommandLog).
        CommandLog = "command_log",
        /// [`FaultNote`](super::FaultNote).
        Events = "events",
        /// [`Latency`](super::Latency).
        Latency = "latency",
        /// [`Dropped`](super::Dropped).
        Dropped = "dropped",
        /// To the actuator: [`CommandPacket`](crate::link::CommandPacket).
        Command = "command",
        /// From the actuator: the acknowledgement of a command.
        Acknowledged = "acknowledged",
        /// From the localisation: [`PosePacket`](crate::link::PosePacket).
        Pose = "pose",
        /// From the sensor IO to the controller: all inputs of a control step.
        Inputs = "inputs",
    }
}

impl Topic {
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
