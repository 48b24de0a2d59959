//! A client that subscribes to topics of the robot.

use std::net::SocketAddr;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

use rumqttc::{Broker, Client, Event, Incoming, MqttOptions, PublishOptions, QoS};
use vibrissa_robot::telemetry::Topic;

use crate::wait_until;

/// A message as it has arrived.
#[derive(Debug, Clone)]
pub(crate) struct Arrival {
    pub(crate) topic: String,
    pub(crate) payload: Vec<u8>,
    pub(crate) is_retained: bool,
}

impl Arrival {
    pub(crate) fn is_of(&self, topic: Topic) -> bool {
        self.topic.rsplit('/').next() == Some(topic.word())
    }

    pub(crate) fn text(&self) -> &str {
        std::str::from_utf8(&self.payload).unwrap()
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.payload).unwrap()
    }
}

/// A subscriber. It connects again and subscribes again after a loss.
pub(crate) struct Listener {
    state: Arc<Mutex<State>>,
    client: Client,
}

#[derive(Default)]
struct State {
    arrivals: Vec<Arrival>,
    subscriptions: u32,
}

impl Listener {
    /// A subscriber of a topic filter. `answer` sees every message at once.
    pub(crate) fn new(
        broker: SocketAddr,
        filter: &str,
        mut answer: impl FnMut(&Client, &Arrival) + Send + 'static,
    ) -> Self {
        // A broker has one connection with each name.
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let name = format!("listener-{}", NEXT.fetch_add(1, Ordering::Relaxed));
        let mut options = MqttOptions::new(name, Broker::tcp(broker.ip().to_string(), broker.port()));
        // The library forgets messages that it reads together with the end of a connection.
        options.set_max_packet_size(1 << 20, 1 << 20).set_read_batch_size(1);
        let (client, mut connection) = Client::builder(options).capacity(1000).build();
        let (state, own, filter) = (Arc::<Mutex<State>>::default(), client.clone(), filter.to_owned());
        let shared = Arc::clone(&state);
        std::thread::spawn(move || {
            for event in connection.iter() {
                match event {
                    Ok(Event::Incoming(Incoming::ConnAck(_))) => own.subscribe(&*filter, QoS::AtMostOnce).unwrap(),
                    Ok(Event::Incoming(Incoming::SubAck(_))) => shared.lock().unwrap().subscriptions += 1,
                    Ok(Event::Incoming(Incoming::Publish(message))) => {
                        let arrival = Arrival {
                            topic: String::from_utf8(message.topic.to_vec()).unwrap(),
                            payload: message.payload.to_vec(),
                            is_retained: message.retain,
                        };
                        answer(&own, &arrival);
                        shared.lock().unwrap().arrivals.push(arrival);
                    }
                    Ok(_) => {}
                    Err(_) => std::thread::sleep(Duration::from_millis(10)),
                }
            }
        });
        let listener = Self { state, client };
        listener.wait_for_subscription(1);
        listener
    }

    /// A subscriber of all topics of the robot.
    pub(crate) fn of_all(broker: SocketAddr) -> Self {
        Self::new(broker, "vibrissa/#", |_, _| {})
    }

    /// Waits until the broker has confirmed the subscription so many times.
    pub(crate) fn wait_for_subscription(&self, count: u32) {
        wait_until("the subscription", || self.state().subscriptions >= count);
    }

    /// The messages that have arrived on a topic.
    pub(crate) fn on(&self, topic: Topic) -> Vec<Arrival> {
        self.state().arrivals.iter().filter(|arrival| arrival.is_of(topic)).cloned().collect()
    }

    /// All messages that have arrived.
    pub(crate) fn all(&self) -> Vec<Arrival> {
        self.state().arrivals.clone()
    }

    /// Waits until the status of the robot is this text.
    pub(crate) fn wait_for_status(&self, text: &str) {
        wait_until(&format!("the status {text}"), || {
            self.on(Topic::Status).last().is_some_and(|arrival| arrival.text() == text)
        });
    }

    /// Publishes a message.
    pub(crate) fn publish(&self, topic: &str, payload: &[u8], options: PublishOptions) {
        // Without a broker the message is worthless.
        let _ = self.client.try_publish(topic, payload.to_vec(), options);
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        let _ = self.client.try_disconnect();
    }
}
