//! The channels of a recording.

use super::records::FileMessage;

/// A channel of a recording. Its messages are JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Channel {
    /// The inputs of a step of the control task.
    Steps,
    /// The results of a step that has executed the machine.
    Ticks,
    /// Changes of faults.
    Events,
    /// Packets to the actuator.
    Packets,
}

impl Channel {
    pub(super) const ALL: [Self; 4] = [Self::Steps, Self::Ticks, Self::Events, Self::Packets];

    /// The topic.
    pub(super) fn topic(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Ticks => "ticks",
            Self::Events => "events",
            Self::Packets => "packets",
        }
    }

    /// The channel with a topic.
    pub(super) fn of(topic: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.topic() == topic)
    }

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

    /// The number of the channel, from 0.
    pub(super) fn index(self) -> usize {
        self as usize
    }
}

/// An encoded message. Its sequence number counts within the channel, from 0 at the start of the program. A gap is a loss. Its time
/// is counted from the start of the program, and its content is JSON.
pub(super) type Message = FileMessage<Channel>;
