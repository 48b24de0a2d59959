//! A thread that exchanges current messages with a broker.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::Waker;
use std::thread::JoinHandle;
use std::time::Duration;

use crate::config::MqttConfig;
use crate::mqtt::{Broker, BrokerEvent, Message, Options, RumqttBroker, Session, StartError, Traffic};

/// The longest wait for an event.
const LOOK: Duration = Duration::from_secs(1);
/// Bytes of commands, acknowledgements or poses that the system keeps.
pub(crate) const PACKET_BYTES: u32 = 4096;
/// The time for the last message at the end.
const FAREWELL: Duration = Duration::from_millis(200);

/// A thread with a connection of its own. What cannot be sent at once is dropped, because old commands and poses are
/// worthless. Dropping the link ends its thread.
#[derive(Debug)]
pub(crate) struct MqttLink {
    must_end: Arc<AtomicBool>,
    waker: Waker,
    thread: Option<JoinHandle<()>>,
}

impl MqttLink {
    /// A link of the robot with this name. It receives messages of the topic `subscription` by `receive`. It sends the
    /// messages that `next` has when [`wake`](Self::wake) is called, of which the system keeps so many `bytes`. `purpose`
    /// distinguishes the robot's links.
    ///
    /// # Errors
    /// [`StartError`] if the connection cannot begin.
    pub(crate) fn start(
        robot: &str,
        purpose: &str,
        config: &MqttConfig,
        bytes: u32,
        subscription: Option<String>,
        next: impl FnMut() -> Option<Message> + Send + 'static,
        receive: impl FnMut(&[u8]) + Send + 'static,
    ) -> Result<Self, StartError> {
        let client = format!("vibrissa-{robot}-{purpose}");
        let options = Options::new(config, client, None, Traffic::Current { bytes })?;
        let (session, must_end) = (Session::new(RumqttBroker::new(options)?), Arc::new(AtomicBool::new(false)));
        let (waker, own) = (session.waker(), Arc::clone(&must_end));
        let body = move || exchange(session, &own, subscription.as_deref(), next, receive);
        let thread = Some(std::thread::Builder::new().name(format!("mqtt {purpose}")).spawn(body)?);
        Ok(Self { must_end, waker, thread })
    }

    /// Announces a message. This neither blocks nor allocates.
    pub(crate) fn wake(&self) {
        self.waker.wake_by_ref();
    }
}

impl Drop for MqttLink {
    fn drop(&mut self) {
        self.must_end.store(true, Ordering::Release);
        self.wake();
        if let Some(thread) = self.thread.take() {
            // After a panic of the thread, the missing acknowledgements or poses have stopped the robot.
            let _ = thread.join();
        }
    }
}

fn exchange<B: Broker>(
    mut session: Session<B>,
    must_end: &AtomicBool,
    subscription: Option<&str>,
    mut next: impl FnMut() -> Option<Message>,
    mut receive: impl FnMut(&[u8]),
) {
    loop {
        // The flag comes before the last message.
        let has_ended = must_end.load(Ordering::Acquire);
        while let Some(message) = next() {
            if session.is_connected() {
                let _ = session.publish(&message, None);
            }
        }
        if has_ended {
            break;
        }
        match session.next_event(LOOK) {
            Some(BrokerEvent::Connected) => {
                // It is the first request of a new connection, which accepts it.
                if let Some(subscription) = subscription {
                    let _ = session.subscribe(subscription);
                }
            }
            // A message that the broker has kept is old.
            Some(BrokerEvent::Received { payload, is_retained: false }) => receive(&payload),
            _ => {}
        }
    }
    session.disconnect(FAREWELL);
}
