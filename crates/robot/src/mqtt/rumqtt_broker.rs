//! A connection by the library rumqttc.

use std::collections::BTreeMap;
use std::io::Write;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::task::{Wake, Waker};
use std::time::{Duration, Instant};
use vibrissa_text::system::in_words;

use rumqttc::{
    AsyncClient, Broker as Address, ConnectReturnCode, ConnectionError, Event, EventLoop, Incoming, LastWill,
    MqttOptions, NetworkOptions, Outgoing, PublishOptions, QoS, TlsConfiguration, Transport,
};
use tokio::runtime::Runtime;

use super::access::{Access, AccessError, Authorities};
use super::broker::{Broker, BrokerEvent, Busy, Message};
use crate::config::MqttConfig;

/// Time (s) without other packets after which the broker is asked for a sign of life. It has as long to answer.
const KEEP_ALIVE_S: u16 = 5;
/// The longest time (s) of an attempt to connect, and of one to send.
const TIMEOUT_S: u64 = 3;
/// The largest message (bytes). Those of this program are much smaller.
const LARGEST_MESSAGE: usize = 1 << 20;
/// Events that wait for [`Broker::next_event`]. Then the connection reads no more.
const EVENTS: usize = 64;

/// Properties of a connection.
#[derive(Clone)]
pub struct Options {
    /// Name or address of the broker.
    pub host: String,
    /// Its port.
    pub port: u16,
    /// User and encryption.
    pub access: Access,
    /// Name of the client. A broker has at most one connection with each name.
    pub client: String,
    /// The message that the broker publishes if the connection ends without [`Broker::disconnect`].
    pub last_will: Option<Message>,
    /// The messages that may wait in the connection.
    pub traffic: Traffic,
}

/// A connection that cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The system has no more files or threads.
    #[error("the system starts no connection to the MQTT broker: {words}; end other programs", words = in_words(.0))]
    System(#[from] std::io::Error),
    /// A file cannot be used.
    #[error(transparent)]
    Access(#[from] AccessError),
    /// The system has no authorities.
    #[error("the system gives no certificates of authorities ({0}); write the `ca` of the broker into `tls` of `mqtt`")]
    Authorities(String),
}

impl Options {
    /// A connection of a client with this name to a broker.
    ///
    /// # Errors
    /// [`AccessError`] if a file cannot be used.
    pub fn new(
        config: &MqttConfig,
        client: String,
        last_will: Option<Message>,
        traffic: Traffic,
    ) -> Result<Self, AccessError> {
        let access = Access::read(config)?;
        Ok(Self { host: config.host.clone(), port: config.port, access, client, last_will, traffic })
    }
}

/// The messages that may wait in a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Traffic {
    /// Messages that keep their value: up to this many.
    Complete(u16),
    /// Messages that are worthless once they are old: a few. The system keeps so many bytes of them.
    Current {
        /// Size of the system's buffer.
        bytes: u32,
    },
}

/// Messages that may wait in a connection with current messages.
const CURRENT_MESSAGES: u16 = 4;

/// A connection by the library rumqttc. Its tasks run on the thread that waits for events.
pub struct RumqttBroker {
    options: MqttOptions,
    network: NetworkOptions,
    capacity: u16,
    runtime: Runtime,
    interruption: Arc<Interruption>,
    /// The other end of the interruption.
    interrupted: tokio::net::UnixStream,
    connection: Option<Connection>,
}

struct Connection {
    client: AsyncClient,
    /// Receipts of published messages, in the order of publication.
    receipts: Sender<u64>,
    events: tokio::sync::mpsc::Receiver<BrokerEvent>,
    task: tokio::task::JoinHandle<()>,
}

/// Ends a wait by a byte in a socket. Wakers of tokio have locks, for which a real-time thread must not wait.
#[derive(Debug)]
struct Interruption(UnixStream);

impl Wake for Interruption {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        // A full socket ends the wait as well.
        let _ = (&self.0).write(&[0]);
    }
}

impl RumqttBroker {
    /// A broker without a connection.
    ///
    /// # Errors
    /// [`StartError`] if the system has no more files, or no authorities for certificates.
    pub fn new(options: Options) -> Result<Self, StartError> {
        let mut mqtt = MqttOptions::new(options.client, Address::tcp(options.host, options.port));
        mqtt.set_keep_alive(KEEP_ALIVE_S).set_max_packet_size(LARGEST_MESSAGE, LARGEST_MESSAGE);
        if let Some((name, password)) = options.access.user {
            mqtt.set_credentials(name, password);
        }
        if let Some(authorities) = options.access.authorities {
            let tls = match authorities {
                Authorities::System => TlsConfiguration::try_default_rustls()
                    .map_err(|error| StartError::Authorities(error.to_string()))?,
                Authorities::Certificates(ca) => TlsConfiguration::Simple { ca, alpn: None, client_auth: None },
            };
            mqtt.set_transport(Transport::tls_with_config(tls));
        }
        if let Some(will) = options.last_will {
            mqtt.set_last_will(LastWill::new(&*will.topic, will.payload, QoS::AtLeastOnce, will.is_retained));
        }
        let mut network = NetworkOptions::new();
        network.set_tcp_nodelay(true);
        network.set_connection_timeout(TIMEOUT_S);
        let capacity = match options.traffic {
            Traffic::Complete(messages) => messages,
            Traffic::Current { bytes } => {
                network.set_tcp_send_buffer_size(bytes);
                CURRENT_MESSAGES
            }
        };
        mqtt.set_inflight(capacity);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build()?;
        let (sender, receiver) = UnixStream::pair()?;
        sender.set_nonblocking(true)?;
        receiver.set_nonblocking(true)?;
        let interrupted = {
            let _context = runtime.enter();
            tokio::net::UnixStream::from_std(receiver)?
        };
        let interruption = Arc::new(Interruption(sender));
        Ok(Self { options: mqtt, network, capacity, runtime, interruption, interrupted, connection: None })
    }
}

impl Broker for RumqttBroker {
    fn connect(&mut self) {
        self.end();
        let builder = AsyncClient::builder(self.options.clone()).capacity(usize::from(self.capacity));
        let (client, mut event_loop) = builder.build();
        event_loop.set_network_options(self.network.clone());
        let (receipts, published) = channel();
        let (sender, events) = tokio::sync::mpsc::channel(EVENTS);
        let task = self.runtime.spawn(run(event_loop, published, sender));
        self.connection = Some(Connection { client, receipts, events, task });
    }

    fn subscribe(&mut self, topic: &str) -> Result<(), Busy> {
        let connection = self.connection.as_ref().ok_or(Busy)?;
        connection.client.try_subscribe(topic, QoS::AtMostOnce).map_err(|_| Busy)
    }

    fn publish(&mut self, message: &Message, receipt: Option<u64>) -> Result<(), Busy> {
        let connection = self.connection.as_ref().ok_or(Busy)?;
        let quality = if receipt.is_some() { QoS::AtLeastOnce } else { QoS::AtMostOnce };
        let options = PublishOptions::new(quality).retain(message.is_retained);
        connection.client.try_publish(&*message.topic, message.payload.clone(), options).map_err(|_| Busy)?;
        if let Some(receipt) = receipt {
            // The receiver is gone only after the connection, which reports that.
            let _ = connection.receipts.send(receipt);
        }
        Ok(())
    }

    fn next_event(&mut self, at_most: Duration) -> Option<BrokerEvent> {
        let interrupted = &self.interrupted;
        let connection = self.connection.as_mut();
        let event = self.runtime.block_on(async {
            let event = async {
                match connection {
                    Some(connection) => connection.events.recv().await.unwrap_or_else(ended),
                    None => std::future::pending().await,
                }
            };
            tokio::select! {
                biased;
                event = event => Some(event),
                () = interruption(interrupted) => None,
                () = tokio::time::sleep(at_most) => None,
            }
        });
        if matches!(event, Some(BrokerEvent::Lost(_))) {
            self.end();
        }
        event
    }

    fn waker(&self) -> Waker {
        Waker::from(Arc::clone(&self.interruption))
    }

    fn disconnect(mut self, at_most: Duration) {
        let end = Instant::now() + at_most;
        if let Some(connection) = &self.connection {
            // Without capacity there is no farewell, and the broker publishes the last will.
            let _ = connection.client.try_disconnect_with_timeout(at_most);
        }
        while self.connection.is_some() {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            let _ = self.next_event(left);
        }
        // A search for the broker's address must not delay the end.
        self.runtime.shutdown_background();
    }
}

impl RumqttBroker {
    fn end(&mut self) {
        if let Some(connection) = self.connection.take() {
            connection.task.abort();
        }
    }
}

/// Waits for an interruption, and takes all of them.
async fn interruption(interrupted: &tokio::net::UnixStream) {
    // The other end exists, so there is no error.
    let _ = interrupted.readable().await;
    let mut bytes = [0; 64];
    while interrupted.try_read(&mut bytes).is_ok_and(|count| count > 0) {}
}

/// The event of a connection whose task is gone.
fn ended() -> BrokerEvent {
    BrokerEvent::Lost("the connection has ended".to_owned())
}

/// Runs a connection until it is lost.
async fn run(mut event_loop: EventLoop, published: Receiver<u64>, events: tokio::sync::mpsc::Sender<BrokerEvent>) {
    // The receipts of messages that the broker has not acknowledged, by the numbers of their packets.
    let mut receipts = BTreeMap::new();
    loop {
        let event = match event_loop.poll().await {
            Ok(Event::Incoming(Incoming::ConnAck(_))) => BrokerEvent::Connected,
            Ok(Event::Incoming(Incoming::Publish(message))) => {
                BrokerEvent::Received { payload: message.payload.to_vec(), is_retained: message.retain }
            }
            // Packets have numbers if they are acknowledged. Those have receipts.
            Ok(Event::Outgoing(Outgoing::Publish(number))) if number != 0 => {
                if let Ok(receipt) = published.try_recv() {
                    receipts.insert(number, receipt);
                }
                continue;
            }
            Ok(Event::Incoming(Incoming::PubAck(packet))) => match receipts.remove(&packet.pkid) {
                Some(receipt) => BrokerEvent::Acknowledged(receipt),
                None => continue,
            },
            Ok(_) => continue,
            Err(error) => BrokerEvent::Lost(reason(&error)),
        };
        let is_lost = matches!(event, BrokerEvent::Lost(_));
        if events.send(event).await.is_err() || is_lost {
            return;
        }
    }
}

/// The reason why a connection is lost, with the remedy where the configuration has one.
fn reason(error: &ConnectionError) -> String {
    match error {
        ConnectionError::ConnectionRefused(
            ConnectReturnCode::BadUserNamePassword | ConnectReturnCode::NotAuthorized,
        ) => "the broker refuses the user; check `user` and `password_file` of `mqtt`".to_owned(),
        ConnectionError::Tls(error) => {
            format!("{error}; check `tls` of `mqtt`, and that the certificate of the broker is for its `host`")
        }
        ConnectionError::Io(error) => in_words(error),
        error => error.to_string(),
    }
}
