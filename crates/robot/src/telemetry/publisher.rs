//! The thread that publishes the messages of an outbox.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::Waker;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::outbox::{Outbox, WINDOW};
use super::payload::{Dropped, OFFLINE, ONLINE};
use super::topic::Topic;
use crate::config::MqttConfig;
use crate::mqtt::{Broker, BrokerEvent, Message, Options, RumqttBroker, Session, StartError, Traffic};

/// The longest wait for an event.
const LOOK: Duration = Duration::from_secs(1);
/// The time for messages that the broker does not have at the end of the program.
const END: Duration = Duration::from_secs(1);
/// The time for the farewell after that.
const FAREWELL: Duration = Duration::from_millis(300);

/// Publishes messages on a thread of its own. No call waits for the broker, except for [`end`](Self::end).
#[derive(Debug)]
pub struct Publisher {
    shared: Arc<Shared>,
    waker: Waker,
    thread: Option<JoinHandle<()>>,
}

/// What both threads use. They hold the lock only for moments.
#[derive(Debug)]
struct Shared {
    outbox: Mutex<Outbox>,
    is_broker_gone: AtomicBool,
    must_end: AtomicBool,
}

impl Shared {
    fn outbox(&self) -> MutexGuard<'_, Outbox> {
        // Every change of an outbox is complete before it can panic.
        self.outbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Publisher {
    /// A publisher for the robot with this name. It connects at once. `log` receives the reason why a connection is lost,
    /// and the news that it is back.
    ///
    /// # Errors
    /// [`StartError`] if the connection cannot begin.
    pub fn start(robot: &str, config: &MqttConfig, log: impl FnMut(&str) + Send + 'static) -> Result<Self, StartError> {
        let client = format!("vibrissa-{robot}-telemetry");
        // Some more than the window, for the status.
        let traffic = Traffic::Complete(WINDOW + 8);
        let options = Options::new(config, client, Some(status(robot, OFFLINE)), traffic)?;
        Ok(Self::start_with(RumqttBroker::new(options)?, robot, config.buffer, log)?)
    }

    /// A publisher with another client.
    ///
    /// # Errors
    /// The system's error if it has no more threads.
    fn start_with<B>(
        broker: B,
        robot: &str,
        buffer: usize,
        log: impl FnMut(&str) + Send + 'static,
    ) -> std::io::Result<Self>
    where
        B: Broker + 'static,
    {
        let topic: Arc<str> = Topic::Dropped.of(robot).into();
        let report = move |dropped_messages| {
            let payload = serde_json::to_vec(&Dropped { dropped_messages }).unwrap_or_default();
            Message { topic: Arc::clone(&topic), payload, is_retained: false }
        };
        let shared = Arc::new(Shared {
            outbox: Mutex::new(Outbox::new(buffer, report)),
            is_broker_gone: AtomicBool::new(false),
            must_end: AtomicBool::new(false),
        });
        let (session, own) = (Session::new(broker), Arc::clone(&shared));
        let (waker, online, offline) = (session.waker(), status(robot, ONLINE), status(robot, OFFLINE));
        let body = move || publish(session, &own, &online, &offline, log);
        let thread = Some(std::thread::Builder::new().name("mqtt".to_owned()).spawn(body)?);
        Ok(Self { shared, waker, thread })
    }

    /// Adds a message.
    pub fn push(&self, message: Message) {
        self.shared.outbox().push(message);
        self.waker.wake_by_ref();
    }

    /// Messages that the broker does not have, and messages that have been dropped.
    #[must_use]
    pub fn counts(&self) -> (usize, u64) {
        let outbox = self.shared.outbox();
        (outbox.len(), outbox.dropped())
    }

    /// True after a connection has been lost, or could not be made, until there is one.
    #[must_use]
    pub fn is_broker_gone(&self) -> bool {
        self.shared.is_broker_gone.load(Ordering::Acquire) || self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Publishes the messages that are left and the status `offline`, and ends the connection. Without a broker, this takes
    /// a second.
    pub fn end(&mut self) {
        self.shared.must_end.store(true, Ordering::Release);
        self.waker.wake_by_ref();
        if let Some(thread) = self.thread.take() {
            // After a panic of the thread, the broker publishes the last will.
            let _ = thread.join();
        }
    }
}

impl Drop for Publisher {
    fn drop(&mut self) {
        self.end();
    }
}

fn status(robot: &str, text: &str) -> Message {
    let topic = Topic::Status;
    Message { topic: topic.of(robot).into(), payload: text.into(), is_retained: topic.is_retained() }
}

/// Publishes until the end.
fn publish<B: Broker>(
    mut session: Session<B>,
    shared: &Shared,
    online: &Message,
    offline: &Message,
    mut log: impl FnMut(&str),
) {
    let mut end = None;
    loop {
        if shared.must_end.load(Ordering::Acquire) {
            let end = *end.get_or_insert_with(|| Instant::now() + END);
            if Instant::now() >= end || session.is_connected() && shared.outbox().is_empty() {
                break;
            }
        }
        if session.is_connected() {
            let mut outbox = shared.outbox();
            while outbox.send_next(|receipt, message| session.publish(message, Some(receipt))) == Ok(true) {}
        }
        let look = end.map_or(LOOK, |end: Instant| end.saturating_duration_since(Instant::now()));
        match session.next_event(look) {
            Some(BrokerEvent::Connected) => {
                // It is the first message of a new connection, which accepts it.
                let _ = session.publish(online, None);
                if shared.is_broker_gone.swap(false, Ordering::AcqRel) {
                    log("the MQTT broker is back");
                }
            }
            Some(BrokerEvent::Acknowledged(receipt)) => shared.outbox().acknowledge(receipt),
            Some(BrokerEvent::Lost(reason)) => {
                shared.outbox().connection_lost();
                if !shared.is_broker_gone.swap(true, Ordering::AcqRel) {
                    log(&format!("the MQTT broker is gone: {reason}"));
                }
            }
            Some(BrokerEvent::Received { .. }) | None => {}
        }
    }
    if session.is_connected() {
        let _ = session.publish(offline, None);
    }
    session.disconnect(FAREWELL);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::mqtt::Busy;

    /// A broker that loses the first connection after some messages, and acknowledges those of the second connection.
    struct Unreliable {
        connections: u32,
        /// Receipts that are not acknowledged yet.
        open: Vec<u64>,
        is_accepting: bool,
        received: Arc<Mutex<Vec<(u32, String)>>>,
    }

    /// Messages that the first connection carries.
    const CARRIED: usize = 5;

    impl Broker for Unreliable {
        fn connect(&mut self) {
            self.connections += 1;
            (self.is_accepting, self.open) = (true, Vec::new());
        }

        fn subscribe(&mut self, _topic: &str) -> Result<(), Busy> {
            Err(Busy)
        }

        fn publish(&mut self, message: &Message, receipt: Option<u64>) -> Result<(), Busy> {
            if self.connections == 1 && self.open.len() == CARRIED {
                return Err(Busy);
            }
            self.open.extend(receipt);
            self.received.lock().unwrap().push((self.connections, String::from_utf8(message.payload.clone()).unwrap()));
            Ok(())
        }

        fn next_event(&mut self, at_most: Duration) -> Option<BrokerEvent> {
            if std::mem::take(&mut self.is_accepting) {
                return Some(BrokerEvent::Connected);
            }
            match self.connections {
                1 if self.open.len() == CARRIED => {
                    self.open.clear();
                    Some(BrokerEvent::Lost("test".to_owned()))
                }
                2 if !self.open.is_empty() => Some(BrokerEvent::Acknowledged(self.open.remove(0))),
                _ => {
                    std::thread::sleep(at_most.min(Duration::from_millis(1)));
                    None
                }
            }
        }

        fn waker(&self) -> Waker {
            Waker::noop().clone()
        }

        fn disconnect(self, _at_most: Duration) {}
    }

    #[test]
    fn messages_without_an_acknowledgement_are_sent_again_between_online_and_offline() {
        let received = Arc::new(Mutex::new(Vec::new()));
        let broker =
            Unreliable { connections: 0, open: Vec::new(), is_accepting: false, received: Arc::clone(&received) };
        let logged = Arc::new(Mutex::new(Vec::new()));
        let own = Arc::clone(&logged);
        let log = move |text: &str| own.lock().unwrap().push(text.to_owned());
        let mut publisher = Publisher::start_with(broker, "test", 100, log).unwrap();
        for number in 0..20 {
            publisher.push(Message { topic: "test".into(), payload: number.to_string().into(), is_retained: false });
        }
        while publisher.counts().0 > 0 {
            std::thread::sleep(Duration::from_millis(1));
        }
        publisher.end();
        let received = received.lock().unwrap();
        let on = |connection: u32| -> Vec<&str> {
            received.iter().filter(|(own, _)| *own == connection).map(|(_, text)| text.as_str()).collect()
        };
        assert_eq!(on(1), [ONLINE, "0", "1", "2", "3", "4"]);
        let second: Vec<String> = (0..20).map(|number: u32| number.to_string()).collect();
        assert_eq!(on(2)[0], ONLINE);
        assert_eq!(on(2)[1..=20], second);
        assert_eq!(on(2)[21..], [OFFLINE]);
        assert_eq!(*logged.lock().unwrap(), ["the MQTT broker is gone: test", "the MQTT broker is back"]);
    }
}
