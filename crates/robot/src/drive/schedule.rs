//! The schedule that the real threads and the emulation share.

/// Period of the supervisor (ns).
pub(crate) const SUPERVISION_NS: u64 = 10_000_000;
/// Start of a control tick after that of its last round (ns), when the round has ended: 45 % of a sample period (ns).
pub(crate) fn tick_offset_ns(sample_period_ns: u64) -> u64 {
    sample_period_ns * 9 / 20
}

/// Entries of a queue between two threads: almost a second of rounds.
pub(crate) const QUEUE: usize = 256;
