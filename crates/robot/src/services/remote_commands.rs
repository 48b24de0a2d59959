//! The commands of a controller on the other side of a broker.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rtrb::{Consumer, RingBuffer};
use vibrissa_runtime::signal::Command;

use crate::config::{Config, MqttConfig};
use crate::link::{CommandGate, CommandPacket, CommandVerdict, MqttLink, PACKET_BYTES, StampedCommand};
use crate::mqtt::{Message, StartError};
use crate::telemetry::{Source, Topic};
use crate::vitals::Vitals;

/// Packets that wait for the supervisor.
const PACKETS: usize = 64;

/// The packets of the controller, for the supervisor of the sensor IO. A packet is acknowledged once it has been forwarded.
#[derive(Debug)]
pub struct RemoteCommands {
    packets: Consumer<CommandPacket>,
    gate: CommandGate,
    /// The newest packet that was taken.
    newest: Option<CommandPacket>,
    acknowledged: Arc<AtomicU64>,
    link: MqttLink,
    vitals: Arc<Vitals>,
}

impl RemoteCommands {
    /// The commands for a robot.
    ///
    /// # Errors
    /// [`StartError`] if the connection cannot begin.
    pub fn new(config: &Config, broker: &MqttConfig, vitals: Arc<Vitals>) -> Result<Self, StartError> {
        let name = Source::SensorIo.name(&config.name);
        let (mut producer, packets) = RingBuffer::new(PACKETS);
        let acknowledged = Arc::new(AtomicU64::new(0));
        let (own, topic, mut last) = (Arc::clone(&acknowledged), Arc::from(Topic::Acknowledged.of(&name)), 0);
        let next = move || {
            let sequence = own.load(Ordering::Acquire);
            let is_new = std::mem::replace(&mut last, sequence) != sequence;
            is_new.then(|| Message {
                topic: Arc::clone(&topic),
                payload: CommandPacket::acknowledgement_of(sequence).to_vec(),
                is_retained: Topic::Acknowledged.is_retained(),
            })
        };
        let receive = move |bytes: &[u8]| {
            if let Ok(packet) = CommandPacket::from_bytes(bytes) {
                // A full queue means that the supervisor hangs.
                let _ = producer.push(packet);
            }
        };
        let subscription = Some(Topic::Command.of(&name));
        let link = MqttLink::start(&name, "forward", broker, PACKET_BYTES, subscription, next, receive)?;
        let gate = CommandGate::new(config.timeouts.control_ns());
        Ok(Self { packets, gate, newest: None, acknowledged, link, vitals })
    }

    /// The newest command since the last call. When it was sent, the controller has lived. Commands that are old or out of order are
    /// not taken.
    pub fn take(&mut self, now_ns: u64) -> Option<StampedCommand> {
        let mut taken = None;
        while let Ok(packet) = self.packets.pop() {
            match self.gate.take(&packet, now_ns) {
                CommandVerdict::Taken { sent_ns } => taken = Some((packet, sent_ns)),
                CommandVerdict::Refused => {}
                CommandVerdict::Restarted => {
                    // The supervisor sees the silence before it, and stops the platform.
                    while self.packets.pop().is_ok() {}
                }
            }
        }
        let (packet, sent_ns) = taken?;
        self.newest = Some(packet);
        self.vitals.tick_ns.fetch_max(sent_ns, Ordering::AcqRel);
        self.vitals.is_running.store(true, Ordering::Release);
        Some(StampedCommand { time_ns: now_ns, command: packet.command })
    }

    /// The packet as it leaves: a stop of the controller remains a stop.
    #[must_use]
    pub fn forwarded(&self, packet: CommandPacket) -> CommandPacket {
        match self.newest {
            Some(newest) if newest.is_stop => CommandPacket { command: Command::STOP, is_stop: true, ..packet },
            _ => packet,
        }
    }

    /// Acknowledges the newest packet. While the sensor IO stops the platform, it does not, so that the machine waits.
    pub fn acknowledge(&mut self, is_stopped: bool) {
        if let Some(newest) = self.newest
            && !is_stopped
        {
            self.acknowledged.store(newest.sequence, Ordering::Release);
            self.link.wake();
        }
    }
}
