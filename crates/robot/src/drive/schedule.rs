//! The schedule that the real threads and the emulation share.

/// The time of a step of the control task, and its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StepTime {
    /// Scheduled time of the step since the start of the program (ns).
    pub due_ns: u64,
    /// The last sample period of the step.
    pub last_slot: u64,
    /// Time of the sample period with the number 0 (ns), on the clock of the poses.
    pub origin_ns: u64,
    /// Start of the last sample period (ns), on the clock of `due_ns`. It gives the age of the samples.
    pub newest_ns: u64,
}

impl StepTime {
    /// The time of a step whose samples and poses are of the same clock as the step.
    #[must_use]
    pub fn new(due_ns: u64, last_slot: u64, origin_ns: u64, sample_period_ns: u64) -> Self {
        Self { due_ns, last_slot, origin_ns, newest_ns: origin_ns + last_slot * sample_period_ns }
    }
}

/// Period of the supervisor (ns).
pub(crate) const SUPERVISION_NS: u64 = 10_000_000;
/// Start of a control tick after that of its last round (ns), when the round has ended: 45 % of a sample period (ns).
pub(crate) fn tick_offset_ns(sample_period_ns: u64) -> u64 {
    sample_period_ns * 9 / 20
}

/// Entries of a queue between two threads: almost a second of rounds.
pub(crate) const QUEUE: usize = 256;
