//! The clock by which runs are compared.

/// The processor's time that this thread has taken (s): what other programs take of the machine does not count, so that ratios hold on a
/// busy one. Only differences mean something.
#[cfg(unix)]
pub(crate) fn processor_time() -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    use std::time::Duration;
    // A time that is negative, or has a billion nanoseconds, is none of a thread.
    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default().as_secs_f64()
}

/// The time that has passed (s), where threads have no clock of their own. Only differences mean something.
#[cfg(not(unix))]
pub(crate) fn processor_time() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::processor_time;
    use std::time::Duration;

    #[test]
    fn work_takes_time_and_sleep_hardly_any() {
        let start = processor_time();
        let mut sum = 0_u64;
        while processor_time() - start < 0.005 {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
        let start = processor_time();
        std::thread::sleep(Duration::from_millis(20));
        let slept = processor_time() - start;
        assert!(!cfg!(unix) || slept < 0.01, "{slept} s");
    }
}
