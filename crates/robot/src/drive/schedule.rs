//! The schedule that the real threads and the emulation share.

/// Period of the supervisor (ns).
pub(crate) const SUPERVISION_NS: u64 = 10_000_000;
/// Start of a control tick after that of its last round (ns), when the round has ended.
pub(crate) const TICK_OFFSET_NS: u64 = 1_500_000;
/// Entries of a queue between two threads: almost a second of rounds.
pub(crate) const QUEUE: usize = 256;
