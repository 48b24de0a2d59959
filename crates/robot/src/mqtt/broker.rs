//! The interface of a client library.

use std::sync::Arc;
use std::task::Waker;
use std::time::Duration;

/// A connection to an MQTT broker. One thread uses it. No call blocks, except for the given times.
pub trait Broker: Send {
    /// Begins a new connection. An old one ends, with everything in it that has not been sent.
    fn connect(&mut self);

    /// Asks for the messages of a topic, until the connection ends.
    ///
    /// # Errors
    /// [`Busy`] if the connection accepts nothing now.
    fn subscribe(&mut self, topic: &str) -> Result<(), Busy>;

    /// Sends a message. With a `receipt`, [`BrokerEvent::Acknowledged`] reports that the broker has it, and it may arrive
    /// more than once. Without one, it is sent at most once.
    ///
    /// # Errors
    /// [`Busy`] if the connection accepts nothing now.
    fn publish(&mut self, message: &Message, receipt: Option<u64>) -> Result<(), Busy>;

    /// Waits for the next event. The result is `None` after `at_most`, or if the [`waker`](Self::waker) was called. The
    /// connection sends and receives only meanwhile.
    fn next_event(&mut self, at_most: Duration) -> Option<BrokerEvent>;

    /// Ends a wait, or the next one, from any thread. The waker neither blocks nor allocates.
    fn waker(&self) -> Waker;

    /// Sends what has been accepted, ends the connection, and waits for at most this time. The broker does not publish the
    /// last will.
    fn disconnect(self, at_most: Duration)
    where
        Self: Sized;
}

/// A message to a broker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Its topic.
    pub topic: Arc<str>,
    /// Its content.
    pub payload: Vec<u8>,
    /// True if the broker keeps it for later subscribers.
    pub is_retained: bool,
}

/// An event of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BrokerEvent {
    /// The broker has accepted the connection.
    Connected,
    /// The broker has the message with this receipt.
    Acknowledged(u64),
    /// A message has arrived.
    Received {
        /// The content.
        payload: Vec<u8>,
        /// True if the broker had kept it, so that it may be old.
        is_retained: bool,
    },
    /// The connection has ended, or could not be made, for this reason.
    Lost(String),
}

/// The connection accepts nothing now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Busy;
