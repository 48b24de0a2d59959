//! The commands that a receiver executes.

use super::command_packet::CommandPacket;
use super::order::{Order, Place};
use super::sender_clock::SenderClock;

/// Takes commands in the order of their numbers, and only young ones.
#[derive(Debug, Clone)]
pub struct CommandGate {
    order: Order,
    clock: SenderClock,
    timeout_ns: u64,
}

/// What becomes of a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CommandVerdict {
    /// It is executed. It was sent at this time (ns) of the receiver's clock.
    Taken {
        /// Time of sending (ns).
        sent_ns: u64,
    },
    /// It is out of order or too old.
    Refused,
    /// The sender has started again. Its next packet is executed.
    Restarted,
}

impl CommandGate {
    /// The gate of a receiver that executes commands until this age (ns). After so long without one, a sender may have started again.
    #[must_use]
    pub fn new(timeout_ns: u64) -> Self {
        Self { order: Order::new(timeout_ns), clock: SenderClock::default(), timeout_ns }
    }

    /// The verdict on a packet that arrives at `now_ns`. A stop is taken at any age.
    pub fn take(&mut self, packet: &CommandPacket, now_ns: u64) -> CommandVerdict {
        match self.order.place(packet.sequence, now_ns) {
            Place::Out => return CommandVerdict::Refused,
            Place::Anew => {
                self.clock = SenderClock::default();
                self.clock.age_ns(packet.time_ns, now_ns);
                return CommandVerdict::Restarted;
            }
            Place::Next => {}
        }
        let age_ns = self.clock.age_ns(packet.time_ns, now_ns);
        if age_ns > self.timeout_ns && !packet.is_stop {
            return CommandVerdict::Refused;
        }
        CommandVerdict::Taken { sent_ns: now_ns.saturating_sub(age_ns) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa_runtime::signal::Command;

    const MS: u64 = 1_000_000;
    const TIMEOUT: u64 = 70 * MS;

    fn packet(sequence: u64, sent_ms: u64) -> CommandPacket {
        CommandPacket { sequence, time_ns: sent_ms * MS, command: Command::STOP, is_stop: false }
    }

    /// The times (ms) at which a packet is taken, if these arrive: number, time of sending (ms), and of arrival.
    fn taken(packets: impl IntoIterator<Item = (u64, u64, u64)>) -> Vec<u64> {
        let mut gate = CommandGate::new(TIMEOUT);
        let take = |(sequence, sent_ms, now_ms): (u64, u64, u64)| {
            let verdict = gate.take(&packet(sequence, sent_ms), now_ms * MS);
            matches!(verdict, CommandVerdict::Taken { .. }).then_some(now_ms)
        };
        packets.into_iter().filter_map(take).collect()
    }

    #[test]
    fn a_repeated_or_an_old_packet_is_executed_once() {
        assert_eq!(taken((0..500).map(|index| (1, 0, 10 * index))), [0]);
        assert_eq!(taken((0..500).map(|index| (1 + index % 2, 10 * (index % 2), 10 * index))), [0, 10]);
        assert_eq!(taken((0..500).map(|index| (500 - index, 10 * index, 10 * index))), [0]);
        // With a time that stands still, a packet is older each time.
        assert_eq!(taken((0..500).map(|index| (1 + index, 0, 10 * index))).last(), Some(&70));
    }

    #[test]
    fn a_late_packet_is_not_executed_but_a_late_stop_is() {
        let late = (0..500).map(|index| (1 + index, 10 * index, 10 * index + if index < 100 { 0 } else { 3000 }));
        assert_eq!(taken(late).last(), Some(&990));
        // Within the timeout it may be.
        let jitter = (0..500).map(|index| (1 + index, 10 * index, 10 * index + 7 * (index % 10)));
        assert_eq!(taken(jitter).len(), 500);
        let mut gate = CommandGate::new(TIMEOUT);
        gate.take(&packet(1, 0), 0);
        let stop = CommandPacket { is_stop: true, ..packet(2, 10) };
        assert_eq!(gate.take(&stop, 3000 * MS), CommandVerdict::Taken { sent_ns: 10 * MS });
    }

    #[test]
    fn a_sender_that_starts_again_is_followed_after_the_timeout() {
        let first = (0..100).map(|index| (1 + index, 10 * index, 10 * index));
        let second = (0..100).map(|index| (1 + index, 10 * index, 1500 + 10 * index));
        let times = taken(first.chain(second));
        assert_eq!(times.iter().position(|time| *time >= 1500), Some(100));
        assert_eq!(times.get(100), Some(&1590), "the packet after the first one beyond 70 ms");
        assert_eq!(times.last(), Some(&2490));
    }
}
