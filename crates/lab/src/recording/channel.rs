//! The channels of a recording whose messages are JSON.

use std::sync::Arc;

use foxglove::{Context, RawChannel, Schema};
use serde_json::{Value, json};

use super::error::RecordError;

vibrissa_runtime::kinds! {
    /// A channel whose messages are JSON.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(super) enum JsonChannel,
    /// The topic.
    fn topic {
        /// The samples before each tick.
        Samples = "samples",
        /// Perception and command of each tick, as `run --ticks` writes them.
        Ticks = "ticks",
        /// The state after each tick.
        State = "state",
        /// The guards that were tried in each tick.
        Guards = "guards",
        /// The transitions that were taken.
        Transitions = "transitions",
    }
}

impl JsonChannel {
    /// The name and the text of the schema of its messages.
    fn schema(self) -> (&'static str, &'static str) {
        match self {
            Self::Samples => ("vibrissa.Samples", include_str!("schema/samples.json")),
            Self::Ticks => ("vibrissa.Tick", include_str!("../../schema/tick.schema.json")),
            Self::State => ("vibrissa.State", include_str!("schema/state.json")),
            Self::Guards => ("vibrissa.Guards", include_str!("schema/guards.json")),
            Self::Transitions => ("vibrissa.Transition", include_str!("../../schema/transition.schema.json")),
        }
    }

    /// Opens the channel. `states` are the names of the machine's states.
    pub(super) fn open(self, context: &Arc<Context>, states: &[String]) -> Result<Arc<RawChannel>, RecordError> {
        let (name, schema) = self.schema();
        let schema = match self {
            Self::State => enumerated(schema, states)?,
            _ => schema.as_bytes().to_vec(),
        };
        let schema = Schema::new(name, "jsonschema", schema);
        Ok(context.channel_builder(self.topic()).message_encoding("json").schema(schema).build_raw()?)
    }
}

/// A schema whose properties can have the names of states only, or be empty.
fn enumerated(schema: &str, states: &[String]) -> Result<Vec<u8>, RecordError> {
    let mut schema: Value = serde_json::from_str(schema)?;
    let names: Vec<&str> = states.iter().map(String::as_str).chain([""]).collect();
    if let Some(properties) = schema.get_mut("properties").and_then(Value::as_object_mut) {
        for property in properties.values_mut() {
            property["enum"] = json!(names);
        }
    }
    Ok(serde_json::to_vec(&schema)?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn a_state_is_one_of_the_machine_or_none() {
        let states = ["Following", "Following.Sweeping"].map(str::to_owned);
        let (_, text) = JsonChannel::State.schema();
        let schema: Value = serde_json::from_slice(&enumerated(text, &states).unwrap()).unwrap();
        for property in ["state", "outer"] {
            let property = &schema["properties"][property];
            assert_eq!(property["enum"], json!(["Following", "Following.Sweeping", ""]));
            assert_eq!(property["type"], "string");
        }
    }
}
