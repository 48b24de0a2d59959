//! Real-time scheduling and locked memory.

use rustix::mm::{MlockAllFlags, mlockall};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// The real-time properties that the system has granted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RealTime {
    /// True if the memory is locked, so that no page fault delays a thread.
    pub is_memory_locked: bool,
    /// True if threads can have real-time priority.
    pub has_priority: bool,
}

/// Priority of an acquisition thread.
pub(super) const ACQUISITION_PRIORITY: u8 = 60;
/// Priority of the supervisor. It is above that of control, which it watches.
pub(super) const SUPERVISION_PRIORITY: u8 = 55;
/// Priority of the control thread.
pub(super) const CONTROL_PRIORITY: u8 = 50;

impl RealTime {
    /// Locks the memory and tries the priority of the acquisition on the calling thread. It warns about what the system
    /// refuses, and goes on.
    #[must_use]
    pub fn request(mut warn: impl FnMut(&str)) -> Self {
        let is_memory_locked = mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE).is_ok();
        if !is_memory_locked {
            warn("the memory cannot be locked, so page faults may delay the loop; set LimitMEMLOCK=infinity");
        }
        let has_priority = std::thread::spawn(|| raise_priority(ACQUISITION_PRIORITY)).join().unwrap_or(false);
        if !has_priority {
            warn("threads cannot have real-time priority, so other programs may delay the loop; set LimitRTPRIO=80");
        }
        Self { is_memory_locked, has_priority }
    }

    /// The priority of the threads, for messages.
    pub(super) fn priority(self) -> &'static str {
        if self.has_priority { "real-time priority" } else { "ordinary priority" }
    }
}

/// Gives the calling thread a priority under `SCHED_FIFO`. False if the system refuses.
pub(super) fn raise_priority(priority: u8) -> bool {
    let Ok(value) = ThreadPriorityValue::try_from(priority) else { return false };
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), policy).is_ok()
}
