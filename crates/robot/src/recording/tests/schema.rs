//! The schemas of the channels, compared with the types of the messages.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

use crate::recording::channel::Channel;
use crate::recording::step_message::StepMessage;
use crate::recording::tick_message::{EventMessage, PacketMessage, TickMessage};

fn schema<M: JsonSchema>() -> Value {
    let mut settings = SchemaSettings::draft2020_12().for_serialize();
    settings.inline_subschemas = true;
    settings.into_generator().into_root_schema_for::<M>().into()
}

#[test]
fn every_channel_has_the_schema_of_its_messages() {
    for (channel, schema) in [
        (Channel::Steps, schema::<StepMessage>()),
        (Channel::Ticks, schema::<TickMessage>()),
        (Channel::Events, schema::<EventMessage>()),
        (Channel::Packets, schema::<PacketMessage>()),
    ] {
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            let name = channel.schema_name().trim_start_matches("vibrissa.").to_lowercase();
            let path = format!("{}/src/recording/schema/{name}.json", env!("CARGO_MANIFEST_DIR"));
            std::fs::write(path, serde_json::to_string_pretty(&schema).unwrap() + "\n").unwrap();
        } else {
            let advice = "is stale; run `INSTA_UPDATE=always cargo test -p vibrissa-robot schema`";
            let written: Value = serde_json::from_str(channel.schema()).unwrap();
            assert!(written == schema, "the schema of `{}` {advice}", channel.topic());
        }
    }
}

#[test]
fn the_schemas_have_only_what_viewers_of_recordings_support() {
    for channel in Channel::ALL {
        let schema: Value = serde_json::from_str(channel.schema()).unwrap();
        assert_eq!(schema["type"], "object");
        assert_supported(&schema);
    }
}

/// Lichtblick and Foxglove follow no references. A value has one type, and no list is the direct element of another one.
fn assert_supported(object: &Value) {
    for (name, property) in object["properties"].as_object().unwrap() {
        let element = if property["type"] == "array" { &property["items"] } else { property };
        let kind = element["type"].as_str().unwrap_or_else(|| panic!("`{name}` has not one type"));
        match kind {
            "object" => assert_supported(element),
            kind => assert!(["boolean", "integer", "number", "string"].contains(&kind), "`{name}` is a {kind}"),
        }
    }
}
