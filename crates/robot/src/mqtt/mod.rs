//! The connection to an MQTT broker.
//!
//! The trait [`Broker`] separates the rest of the program from the client library. [`Session`] renews a connection that is
//! lost.

mod access;
mod broker;
mod rumqtt_broker;
mod session;

pub use access::{Access, AccessError};
pub use broker::{Broker, BrokerEvent, Busy, Message};
pub use rumqtt_broker::{Options, RumqttBroker, StartError, Traffic};
pub use session::Session;
