//! The acknowledgements of an actuator.

/// Keeps the time of the last valid acknowledgement.
#[derive(Debug, Default)]
pub(super) struct Acknowledgements {
    /// The newest sequence number that has been sent.
    newest: u64,
    /// The sequence number of the last acknowledgement.
    acknowledged: u64,
    /// Time of that acknowledgement (ns).
    time_ns: Option<u64>,
}

impl Acknowledgements {
    /// A packet with this sequence number has been sent.
    pub(super) fn sent(&mut self, sequence: u64) {
        self.newest = sequence;
    }

    /// The acknowledgement of a packet has been received at `now_ns`. It counts if this packet has been sent, and is another
    /// one than the last.
    pub(super) fn received(&mut self, sequence: u64, now_ns: u64) {
        if sequence <= self.newest && sequence != self.acknowledged {
            self.acknowledged = sequence;
            self.time_ns = Some(now_ns);
        }
    }

    /// Time (ns) of the last acknowledgement. Before the first one, it is that of the first call.
    pub(super) fn last_ns(&mut self, now_ns: u64) -> u64 {
        *self.time_ns.get_or_insert(now_ns)
    }
}
