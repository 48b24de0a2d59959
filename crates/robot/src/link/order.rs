//! The order of the packets of a sender.

/// The largest step between the numbers of two packets. Also a sender that counts nanoseconds, and whose packets are lost for
/// some seconds, stays below. So one packet with a far number does not end the sequence.
const LARGEST_STEP: u64 = 1 << 32;

/// Finds the packets that are in order. Numbers of a sequence grow. A sender that starts again begins a new one: once its numbers
/// have grown for the timeout, without a packet of the old sequence. So neither a repeated packet nor an old one begins one.
#[derive(Debug, Clone)]
pub(crate) struct Order {
    timeout_ns: u64,
    last: Option<u64>,
    /// Packets out of order since the last packet in order.
    run: Option<Run>,
}

/// Packets whose numbers have grown.
#[derive(Debug, Clone, Copy)]
struct Run {
    last: u64,
    begun_ns: u64,
}

/// The place of a packet in the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// It is the first of all, or follows the last.
    Next,
    /// It begins a new sequence.
    Anew,
    /// It is old, repeated, or far ahead.
    Out,
}

impl Order {
    /// The order of a sender that is silent for at most `timeout_ns`.
    pub(crate) fn new(timeout_ns: u64) -> Self {
        Self { timeout_ns, last: None, run: None }
    }

    /// The place of the packet with this number, which arrives at `now_ns`.
    pub(crate) fn place(&mut self, number: u64, now_ns: u64) -> Place {
        if self.last.is_none_or(|last| follows(last, number)) {
            (self.last, self.run) = (Some(number), None);
            return Place::Next;
        }
        let run = match self.run {
            Some(run) if follows(run.last, number) => Run { last: number, ..run },
            _ => Run { last: number, begun_ns: now_ns },
        };
        // A repeated packet is a run of its own each time, so it lasts for no time at all.
        if now_ns.saturating_sub(run.begun_ns) > self.timeout_ns {
            (self.last, self.run) = (Some(number), None);
            return Place::Anew;
        }
        self.run = Some(run);
        Place::Out
    }
}

/// True if a packet with this number can follow the last one.
fn follows(last: u64, number: u64) -> bool {
    number > last && number - last <= LARGEST_STEP
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TIMEOUT: u64 = 60;

    /// The order of packets, one every 10 ns.
    fn places(numbers: impl IntoIterator<Item = u64>) -> Vec<Place> {
        let mut order = Order::new(TIMEOUT);
        (0..).step_by(10).zip(numbers).map(|(now_ns, number)| order.place(number, now_ns)).collect()
    }

    #[test]
    fn a_sender_that_starts_again_begins_a_new_sequence_after_the_timeout() {
        let places = places((1000..1100).chain(1..50));
        assert!(places[..100].iter().all(|place| *place == Place::Next));
        assert!(places[100..107].iter().all(|place| *place == Place::Out));
        assert_eq!(places[107], Place::Anew);
        assert!(places[108..].iter().all(|place| *place == Place::Next));
    }

    #[test]
    fn one_packet_far_ahead_changes_nothing() {
        for far in [u64::MAX, u64::MAX - 1, 1 << 63, (1 << 32) + 8] {
            let places = places((1..8).chain([far]).chain(8..100));
            assert_eq!(places.iter().filter(|place| **place != Place::Next).count(), 1, "{far}");
        }
        // The first of all is taken as it is, and the next sequence begins after the timeout.
        let places = places([u64::MAX].into_iter().chain(1..50));
        assert_eq!(places.iter().position(|place| *place == Place::Anew), Some(8));
        assert!(places[9..].iter().all(|place| *place == Place::Next));
    }

    #[test]
    fn packets_that_are_repeated_never_begin_a_sequence() {
        for cycle in [vec![1], vec![1, 2], vec![5, 4, 3, 2, 1], vec![7, 7, 8]] {
            let places = places((1..20).chain(cycle.iter().copied().cycle().take(200)));
            assert!(places[19..].iter().all(|place| *place == Place::Out), "{cycle:?}");
        }
    }

    #[test]
    fn a_second_sender_does_not_interrupt_the_first() {
        let both = (5000..5200).zip(1..200).flat_map(|(first, second)| [first, second]);
        let places = places(both);
        assert!(places.iter().step_by(2).all(|place| *place == Place::Next));
        assert!(places.iter().skip(1).step_by(2).all(|place| *place == Place::Out));
    }

    proptest! {
        #[test]
        fn whatever_was_sent_before_a_sender_that_counts_is_in_order_soon(numbers: Vec<u64>, begin in 0..u64::MAX - 100) {
            let before = numbers.len();
            let places = places(numbers.into_iter().chain(begin..begin + 50));
            prop_assert!(places[before + 9..].iter().all(|place| *place == Place::Next));
        }
    }
}
