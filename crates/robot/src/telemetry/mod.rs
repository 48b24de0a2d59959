//! Telemetry: topics, payloads, and the sink that publishes the loop's records.
//!
//! [`Topic`] and the payloads need no MQTT client, so that other programs can use them. docs/telemetry.md describes them.

mod lines;
mod measurement;
#[cfg(feature = "mqtt")]
mod outbox;
mod payload;
#[cfg(feature = "mqtt")]
mod publisher;
mod source;
#[cfg(feature = "mqtt")]
mod telemetry_sink;
mod topic;
#[cfg(feature = "mqtt")]
mod translator;

pub use lines::{LineError, lines};
pub use measurement::{Field, FieldKind, MEASUREMENTS, Measurement};
#[cfg(feature = "mqtt")]
pub use outbox::Outbox;
pub use payload::{
    BusSamples, CommandLog, Dropped, Durations, Fault, FaultNote, Health, Latency, MissedPeriods, Motion, Numbered,
    OFFLINE, ONLINE, PerceivedWhisker, Perception, Pose, Samples, SentPacket, State, VERSION, WhiskerSamples,
};
#[cfg(feature = "mqtt")]
pub use publisher::Publisher;
pub use source::Source;
#[cfg(feature = "mqtt")]
pub use telemetry_sink::TelemetrySink;
pub use topic::Topic;
