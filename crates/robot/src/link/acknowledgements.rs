//! The acknowledgements of an actuator.

/// Packets whose times are kept: ten seconds of them. An older acknowledgement counts as none.
const PACKETS: usize = 1024;

/// Finds how old the newest packet is that the receiver has acknowledged. So acknowledgements that are late, repeated, or of packets
/// that have never been sent are no sign of life.
#[derive(Debug)]
pub(crate) struct Acknowledgements {
    /// Number and time (ns) of the newest packets. The entry of a packet is its number modulo [`PACKETS`].
    sent: Box<[(u64, u64)]>,
    /// The largest acknowledged number.
    acknowledged: u64,
    /// Time (ns) at which the packet with this number was sent.
    time_ns: Option<u64>,
}

impl Default for Acknowledgements {
    fn default() -> Self {
        Self { sent: vec![(0, 0); PACKETS].into(), acknowledged: 0, time_ns: None }
    }
}

impl Acknowledgements {
    /// The packet with this sequence number is sent at `now_ns`.
    pub(crate) fn sent(&mut self, sequence: u64, now_ns: u64) {
        if let Some(entry) = self.sent.get_mut(entry(sequence)) {
            *entry = (sequence, now_ns);
        }
    }

    /// The acknowledgement of a packet has been received. It counts if this packet has been sent, and later than every one that was
    /// acknowledged before.
    pub(crate) fn received(&mut self, sequence: u64) {
        if let Some(&(_, sent_ns)) = self.sent.get(entry(sequence)).filter(|(sent, _)| *sent == sequence)
            && sequence > self.acknowledged
        {
            self.acknowledged = sequence;
            self.time_ns = Some(sent_ns);
        }
    }

    /// Time (ns) at which the newest acknowledged packet was sent. Before the first acknowledgement, it is that of the first call.
    pub(crate) fn last_ns(&mut self, now_ns: u64) -> u64 {
        *self.time_ns.get_or_insert(now_ns)
    }
}

/// Entry of a packet in the ring.
fn entry(sequence: u64) -> usize {
    #[expect(clippy::cast_possible_truncation, reason = "below the length of the ring")]
    let entry = (sequence % PACKETS as u64) as usize;
    entry
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ages of the newest acknowledged packet, if packet `n` is sent at `10 n` and then these numbers are received.
    fn ages(steps: u64, answers: impl Fn(u64) -> Vec<u64>) -> Vec<u64> {
        let mut acknowledgements = Acknowledgements::default();
        let step = |sequence| {
            let now_ns = 10 * sequence;
            acknowledgements.sent(sequence, now_ns);
            for answer in answers(sequence) {
                acknowledgements.received(answer);
            }
            now_ns - acknowledgements.last_ns(now_ns)
        };
        (1..=steps).map(step).collect()
    }

    #[test]
    fn an_answer_is_as_old_as_the_packet_that_it_acknowledges() {
        assert!(ages(5000, |sequence| vec![sequence]).iter().all(|age| *age == 0));
        assert!(ages(5000, |sequence| vec![sequence.saturating_sub(20)]).iter().skip(20).all(|age| *age == 200));
        // Out of order, and twice.
        assert!(ages(5000, |sequence| vec![sequence, sequence - 1, sequence]).iter().all(|age| *age == 0));
    }

    #[test]
    fn repeated_old_and_future_answers_are_no_sign_of_life() {
        let repeated = |sequence: u64| vec![1 + sequence % 2];
        for answers in
            [&repeated as &dyn Fn(u64) -> Vec<u64>, &|_| vec![], &|_| vec![0], &|sequence: u64| vec![sequence + 1]]
        {
            assert!(*ages(3000, answers).last().unwrap_or(&0) >= 10 * 2997);
        }
        for far in [u64::MAX, 5000, 1 << 40] {
            let ages = ages(3000, |sequence| if sequence == 100 { vec![far] } else { vec![sequence - sequence % 100] });
            assert!(ages.iter().all(|age| *age < 2000) && ages.last().is_some_and(|age| *age == 0), "{far}");
        }
        // Forgotten after ten seconds.
        assert_eq!(ages(3000, |sequence| vec![sequence.saturating_sub(2000)]).last(), Some(&(10 * 2999)));
    }
}
