//! The commands of a controller on the other side of a broker.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rtrb::{Consumer, RingBuffer};
use vibrissa_runtime::signal::Command;

use crate::config::{Config, MqttConfig};
use crate::link::{CommandPacket, MqttLink, PACKET_BYTES, StampedCommand};
use crate::mqtt::Message;
use crate::telemetry::{Source, Topic};
use crate::vitals::Vitals;

/// Packets that wait for the supervisor.
const PACKETS: usize = 64;

/// The packets of the controller, for the supervisor of the sensor IO. A packet is acknowledged once it has been forwarded.
#[derive(Debug)]
pub struct RemoteCommands {
    packets: Consumer<CommandPacket>,
    /// The newest packet.
    newest: Option<CommandPacket>,
    acknowledged: Arc<AtomicU64>,
    link: MqttLink,
    vitals: Arc<Vitals>,
}

impl RemoteCommands {
    /// The commands for a robot.
    ///
    /// # Errors
    /// The system's error if it has no more files or threads.
    pub fn new(config: &Config, broker: &MqttConfig, vitals: Arc<Vitals>) -> std::io::Result<Self> {
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
        Ok(Self { packets, newest: None, acknowledged, link, vitals })
    }

    /// The newest command since the last call. It is a sign of life of the controller.
    pub fn take(&mut self, now_ns: u64) -> Option<StampedCommand> {
        let newest = std::iter::from_fn(|| self.packets.pop().ok()).last()?;
        self.newest = Some(newest);
        self.vitals.tick_ns.store(now_ns, Ordering::Release);
        self.vitals.is_running.store(true, Ordering::Release);
        Some(StampedCommand { time_ns: now_ns, command: newest.command })
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
