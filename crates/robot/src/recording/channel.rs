//! The channels of a recording.

use super::records::FileMessage;

vibrissa_runtime::kinds! {
    /// A channel of a recording. Its messages are JSON.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub(super) enum Channel,
    /// The topic.
    fn topic {
        /// The inputs of a step of the control task.
        Steps = "steps",
        /// The results of a step that has executed the machine.
        Ticks = "ticks",
        /// Changes of faults.
        Events = "events",
        /// Packets to the actuator.
        Packets = "packets",
    }
}

impl Channel {
    /// The name of the schema of its messages.
    pub(super) fn schema_name(self) -> &'static str {
        match self {
            Self::Steps => "vibrissa.Step",
            Self::Ticks => "vibrissa.Tick",
            Self::Events => "vibrissa.Event",
            Self::Packets => "vibrissa.Packet",
        }
    }

    /// The schema, in JSON Schema.
    pub(super) fn schema(self) -> &'static str {
        match self {
            Self::Steps => include_str!("schema/step.json"),
            Self::Ticks => include_str!("schema/tick.json"),
            Self::Events => include_str!("schema/event.json"),
            Self::Packets => include_str!("schema/packet.json"),
        }
    }
}

/// An encoded message. Its sequence number counts within the channel, from 0 at the start of the program. A gap is a loss. Its time
/// is counted from the start of the program, and its content is JSON.
pub(super) type Message = FileMessage<Channel>;
