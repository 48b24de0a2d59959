//! The messages that the broker does not have yet.

use std::collections::VecDeque;
use std::fmt;

use crate::mqtt::{Busy, Message};

/// Messages that are sent before the broker must acknowledge one of them.
pub(crate) const WINDOW: u16 = 64;

/// The messages that the broker does not have yet, in the order in which they were made.
///
/// A message remains until the broker has acknowledged it. At most `capacity` messages wait for their first transmission.
/// If there are more, the oldest of these is dropped. A message that has been sent once is never dropped, so every
/// dropped message is one that no subscriber has received. Before the next message, a report with the number of dropped
/// messages is sent.
pub struct Outbox {
    capacity: usize,
    /// Messages that have been sent, on this connection or an earlier one, with their receipts.
    sent: VecDeque<(u64, Message)>,
    /// How many of them have been sent on this connection.
    sent_now: usize,
    /// Messages that have not been sent.
    waiting: VecDeque<Message>,
    last_receipt: u64,
    dropped: u64,
    /// Number of dropped messages in the last report.
    reported: u64,
    report: Box<dyn Fn(u64) -> Message + Send>,
}

impl fmt::Debug for Outbox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Outbox")
            .field("sent", &self.sent.len())
            .field("waiting", &self.waiting.len())
            .field("dropped", &self.dropped)
            .finish_non_exhaustive()
    }
}

impl Outbox {
    /// An empty outbox in which `capacity` messages can wait, at least one. `report` makes the message that reports the
    /// number of messages that have been dropped until now.
    #[must_use]
    pub fn new(capacity: usize, report: impl Fn(u64) -> Message + Send + 'static) -> Self {
        Self {
            capacity: capacity.max(1),
            sent: VecDeque::new(),
            sent_now: 0,
            waiting: VecDeque::new(),
            last_receipt: 0,
            dropped: 0,
            reported: 0,
            report: Box::new(report),
        }
    }

    /// Adds a message.
    pub fn push(&mut self, message: Message) {
        if self.waiting.len() >= self.capacity {
            self.waiting.pop_front();
            self.dropped += 1;
        }
        self.waiting.push_back(message);
    }

    /// Sends the next message by `send`, which receives a receipt for it. False if there is no message to send now.
    ///
    /// # Errors
    /// The error of `send`. The message is sent next time.
    pub fn send_next(&mut self, send: impl FnOnce(u64, &Message) -> Result<(), Busy>) -> Result<bool, Busy> {
        if self.sent_now == self.sent.len() {
            let Some(message) = self.next_new() else { return Ok(false) };
            self.last_receipt += 1;
            self.sent.push_back((self.last_receipt, message));
        }
        let Some((receipt, message)) = self.sent.get(self.sent_now) else { return Ok(false) };
        send(*receipt, message)?;
        self.sent_now += 1;
        Ok(true)
    }

    /// The next message that has not been sent, if there may be one more without an acknowledgement.
    fn next_new(&mut self) -> Option<Message> {
        if self.sent.len() >= usize::from(WINDOW) {
            return None;
        }
        if self.reported < self.dropped {
            self.reported = self.dropped;
            return Some((self.report)(self.dropped));
        }
        self.waiting.pop_front()
    }

    /// The broker has the message with this receipt.
    pub fn acknowledge(&mut self, receipt: u64) {
        if let Some(index) = self.sent.iter().take(self.sent_now).position(|(own, _)| *own == receipt) {
            self.sent.remove(index);
            self.sent_now -= 1;
        }
    }

    /// The connection is lost. Messages without an acknowledgement are sent again.
    pub fn connection_lost(&mut self) {
        self.sent_now = 0;
    }

    /// Number of messages that the broker does not have.
    #[must_use]
    pub fn len(&self) -> usize {
        self.sent.len() + self.waiting.len()
    }

    /// True if the broker has all messages.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of messages that have been dropped.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use proptest::prelude::*;

    fn message(text: String) -> Message {
        Message { topic: "test".into(), payload: text.into_bytes(), is_retained: false }
    }

    fn text(message: &Message) -> String {
        String::from_utf8(message.payload.clone()).unwrap()
    }

    /// An event in the life of an outbox.
    #[derive(Debug, Clone)]
    enum Step {
        Push,
        Send {
            is_busy: bool,
        },
        /// The broker acknowledges one of the messages that it has received, and the acknowledgement arrives.
        Acknowledge(prop::sample::Index),
        Lose,
    }

    fn step() -> impl Strategy<Value = Step> {
        prop_oneof![
            4 => Just(Step::Push),
            4 => any::<bool>().prop_map(|is_busy| Step::Send { is_busy }),
            3 => any::<prop::sample::Index>().prop_map(Step::Acknowledge),
            1 => Just(Step::Lose),
        ]
    }

    /// A broker that keeps what it has received, and the receipts that it has not acknowledged.
    #[derive(Default)]
    struct Received {
        all: Vec<String>,
        open: Vec<u64>,
    }

    fn send(outbox: &mut Outbox, broker: &mut Received, is_busy: bool) -> bool {
        let result = outbox.send_next(|receipt, message| {
            if is_busy {
                return Err(Busy);
            }
            broker.all.push(text(message));
            broker.open.push(receipt);
            Ok(())
        });
        result == Ok(true)
    }

    proptest! {
        #[test]
        fn every_message_arrives_in_order_or_is_counted_as_dropped(
            capacity in 1_usize..20, steps in prop::collection::vec(step(), 0..600),
        ) {
            let mut outbox = Outbox::new(capacity, |dropped| message(format!("dropped {dropped}")));
            let (mut broker, mut pushed) = (Received::default(), 0_u64);
            for step in steps {
                match step {
                    Step::Push => {
                        pushed += 1;
                        outbox.push(message(pushed.to_string()));
                    }
                    Step::Send { is_busy } => {
                        send(&mut outbox, &mut broker, is_busy);
                    }
                    Step::Acknowledge(_) if broker.open.is_empty() => {}
                    Step::Acknowledge(index) => {
                        let receipt = broker.open.remove(index.index(broker.open.len()));
                        outbox.acknowledge(receipt);
                    }
                    Step::Lose => {
                        outbox.connection_lost();
                        broker.open.clear();
                    }
                }
                prop_assert!(outbox.len() <= capacity + usize::from(WINDOW));
                prop_assert!(broker.open.len() <= usize::from(WINDOW));
            }
            while !outbox.is_empty() || send(&mut outbox, &mut broker, false) {
                while send(&mut outbox, &mut broker, false) {}
                for receipt in broker.open.drain(..) {
                    outbox.acknowledge(receipt);
                }
            }
            // Each message counts when it arrives for the first time.
            let mut first = Vec::new();
            for text in broker.all {
                if !first.contains(&text) {
                    first.push(text);
                }
            }
            let (reports, numbers): (Vec<_>, Vec<_>) = first.iter().partition(|text| text.starts_with("dropped"));
            let numbers: Vec<u64> = numbers.iter().map(|text| text.parse().unwrap()).collect();
            prop_assert!(numbers.is_sorted());
            prop_assert_eq!(numbers.len() as u64 + outbox.dropped(), pushed);
            let last: Option<u64> = reports.last().map(|text| text["dropped ".len()..].parse().unwrap());
            prop_assert_eq!(last.unwrap_or(0), outbox.dropped());
            // A report counts exactly the messages that are missing before it.
            let (mut missing, mut expected) = (0, 1);
            for text in first {
                if let Some(count) = text.strip_prefix("dropped ") {
                    missing = count.parse::<u64>().unwrap();
                } else {
                    let number: u64 = text.parse().unwrap();
                    expected += 1;
                    prop_assert_eq!(number, expected - 1 + missing);
                }
            }
        }
    }
}
