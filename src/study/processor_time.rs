//! The clock by which runs are compared.

use std::time::Duration;

/// The processor's time that this thread has taken: what other programs take of the machine does not count, so that ratios hold on a
/// busy one. Only differences mean something.
#[cfg(unix)]
pub(super) fn processor_time() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    // A time that is negative, or has a billion nanoseconds, is none of a thread.
    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default()
}

/// The time that has passed, where threads have no clock of their own. Only differences mean something.
#[cfg(not(unix))]
pub(super) fn processor_time() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

#[cfg(test)]
mod tests {
    use super::processor_time;
    use std::time::Duration;

    #[test]
    fn work_takes_time_and_sleep_hardly_any() {
        let start = processor_time();
        let mut sum = 0_u64;
        while processor_time() - start < Duration::from_millis(5) {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
        let start = processor_time();
        std::thread::sleep(Duration::from_millis(20));
        let slept = processor_time() - start;
        assert!(!cfg!(unix) || slept < Duration::from_millis(10), "{slept:?}");
    }
}
