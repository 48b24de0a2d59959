//! The channels of a recording whose messages are JSON.

use std::sync::Arc;

use foxglove::{Context, FoxgloveError, RawChannel, Schema};

/// A channel whose messages are JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum JsonChannel {
    /// The samples before each tick.
    Samples,
    /// Perception and command of each tick, as `run --ticks` writes them.
    Ticks,
    /// The state after each tick.
    State,
    /// The guards that were tried in each tick.
    Guards,
    /// The transitions that were taken.
    Transitions,
}

impl JsonChannel {
    const ALL: [Self; 5] = [Self::Samples, Self::Ticks, Self::State, Self::Guards, Self::Transitions];

    /// The channel with a topic.
    pub(super) fn of(topic: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.topic() == topic)
    }

    /// The topic.
    pub(super) fn topic(self) -> &'static str {
        match self {
            Self::Samples => "samples",
            Self::Ticks => "ticks",
            Self::State => "state",
            Self::Guards => "guards",
            Self::Transitions => "transitions",
        }
    }

    /// The name and the text of the schema of its messages.
    fn schema(self) -> (&'static str, &'static str) {
        match self {
            Self::Samples => ("vibrissa.Samples", include_str!("schema/samples.json")),
            Self::Ticks => ("vibrissa.Tick", include_str!("../../docs/schema/tick.schema.json")),
            Self::State => ("vibrissa.State", include_str!("schema/state.json")),
            Self::Guards => ("vibrissa.Guards", include_str!("schema/guards.json")),
            Self::Transitions => ("vibrissa.Transition", include_str!("../../docs/schema/transition.schema.json")),
        }
    }

    /// Opens the channel.
    pub(super) fn open(self, context: &Arc<Context>) -> Result<Arc<RawChannel>, FoxgloveError> {
        let (name, schema) = self.schema();
        let schema = Schema::new(name, "jsonschema", schema.as_bytes());
        context.channel_builder(self.topic()).message_encoding("json").schema(schema).build_raw()
    }
}
