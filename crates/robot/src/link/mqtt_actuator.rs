//! Commands over MQTT.

use std::sync::Arc;

use rtrb::{Consumer, Producer, RingBuffer};

use super::acknowledgements::Acknowledgements;
use super::actuator::{Actuator, LinkError};
use super::command_packet::CommandPacket;
use super::mqtt_link::{MqttLink, PACKET_BYTES};
use crate::config::MqttConfig;
use crate::mqtt::{Message, StartError};
use crate::telemetry::Topic;

/// Commands that wait until the thread of the link takes the newest of them, and acknowledgements that wait for the supervisor.
const WAITING: usize = 64;

/// An actuator that receives [`CommandPacket`]s from an MQTT broker.
#[derive(Debug)]
pub struct MqttActuator {
    commands: Producer<CommandPacket>,
    link: MqttLink,
    /// Acknowledged sequence numbers, as they arrive.
    acknowledged: Consumer<u64>,
    acknowledgements: Option<Acknowledgements>,
}

impl MqttActuator {
    /// The actuator of the robot with this name. It is `acknowledged` if it answers every packet.
    ///
    /// # Errors
    /// [`StartError`] if the connection cannot begin.
    pub fn new(robot: &str, config: &MqttConfig, is_acknowledged: bool) -> Result<Self, StartError> {
        let (producer, mut commands) = RingBuffer::<CommandPacket>::new(WAITING);
        let topic: Arc<str> = Topic::Command.of(robot).into();
        let next = move || {
            let newest = std::iter::from_fn(|| commands.pop().ok()).last()?;
            let payload = newest.to_bytes().to_vec();
            Some(Message { topic: Arc::clone(&topic), payload, is_retained: Topic::Command.is_retained() })
        };
        let (mut arrivals, acknowledged) = RingBuffer::new(WAITING);
        let receive = move |bytes: &[u8]| {
            if let Ok(sequence) = CommandPacket::acknowledged(bytes) {
                // A full queue means that the supervisor hangs.
                let _ = arrivals.push(sequence);
            }
        };
        let answers = Some(Topic::Acknowledged.of(robot));
        let link = MqttLink::start(robot, "command", config, PACKET_BYTES, answers, next, receive)?;
        let acknowledgements = is_acknowledged.then(Acknowledgements::default);
        Ok(Self { commands: producer, link, acknowledged, acknowledgements })
    }
}

impl Actuator for MqttActuator {
    fn send(&mut self, packet: &CommandPacket) -> Result<(), LinkError> {
        if let Some(acknowledgements) = &mut self.acknowledgements {
            acknowledgements.sent(packet.sequence, packet.time_ns);
        }
        self.commands.push(*packet).map_err(|_| LinkError::Full)?;
        self.link.wake();
        Ok(())
    }

    fn acknowledged_ns(&mut self, now_ns: u64) -> Option<u64> {
        let acknowledgements = self.acknowledgements.as_mut()?;
        while let Ok(sequence) = self.acknowledged.pop() {
            acknowledgements.received(sequence);
        }
        Some(acknowledgements.last_ns(now_ns))
    }
}
