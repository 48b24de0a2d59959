//! A connection that is renewed.

use std::task::Waker;
use std::time::{Duration, Instant};

use super::broker::{Broker, BrokerEvent, Busy, Message};

/// Time from the loss of a connection to the first attempt to renew it. It doubles with every attempt.
const SHORTEST_DELAY: Duration = Duration::from_millis(100);
/// The longest such time.
const LONGEST_DELAY: Duration = Duration::from_secs(5);

/// A connection to a broker. After a loss it is renewed, with growing delays.
#[derive(Debug)]
pub struct Session<B> {
    broker: B,
    state: State,
    delay: Duration,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// There is no connection. The next attempt is at this time.
    Apart(Instant),
    Connecting,
    /// There is a connection since this time.
    Connected(Instant),
}

impl<B: Broker> Session<B> {
    /// A session without a connection. [`next_event`](Self::next_event) makes one.
    #[must_use]
    pub fn new(broker: B) -> Self {
        Self { broker, state: State::Apart(Instant::now()), delay: SHORTEST_DELAY }
    }

    /// True while there is a connection.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        matches!(self.state, State::Connected(_))
    }

    /// Waits for the next event, like [`Broker::next_event`], and makes a connection if it is time for one.
    pub fn next_event(&mut self, at_most: Duration) -> Option<BrokerEvent> {
        let mut wait = at_most;
        if let State::Apart(retry) = self.state {
            let now = Instant::now();
            if now >= retry {
                self.broker.connect();
                self.state = State::Connecting;
            } else {
                wait = wait.min(retry - now);
            }
        }
        let event = self.broker.next_event(wait)?;
        match event {
            BrokerEvent::Connected => self.state = State::Connected(Instant::now()),
            BrokerEvent::Lost(_) => self.lost(),
            BrokerEvent::Acknowledged(_) | BrokerEvent::Received { .. } => {}
        }
        Some(event)
    }

    fn lost(&mut self) {
        let now = Instant::now();
        // A broker that accepts connections and ends them at once is not asked again at once.
        if let State::Connected(since) = self.state
            && now - since > LONGEST_DELAY
        {
            self.delay = SHORTEST_DELAY;
        }
        self.state = State::Apart(now + self.delay);
        self.delay = (2 * self.delay).min(LONGEST_DELAY);
    }

    /// Asks for the messages of a topic.
    ///
    /// # Errors
    /// As [`Broker::subscribe`].
    pub fn subscribe(&mut self, topic: &str) -> Result<(), Busy> {
        self.broker.subscribe(topic)
    }

    /// Sends a message.
    ///
    /// # Errors
    /// As [`Broker::publish`].
    pub fn publish(&mut self, message: &Message, receipt: Option<u64>) -> Result<(), Busy> {
        self.broker.publish(message, receipt)
    }

    /// Ends a wait from any thread.
    #[must_use]
    pub fn waker(&self) -> Waker {
        self.broker.waker()
    }

    /// Ends the connection within this time.
    pub fn disconnect(self, at_most: Duration) {
        let at_most = if self.is_connected() { at_most } else { Duration::ZERO };
        self.broker.disconnect(at_most);
    }
}
