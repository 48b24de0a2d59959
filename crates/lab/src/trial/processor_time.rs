//! The clock of run time comparisons.

/// Processor time of this thread (s). Other programs do not affect it, so that ratios are valid on a busy machine. Only
/// differences are meaningful.
#[cfg(unix)]
pub(crate) fn processor_time() -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    use std::time::Duration;
    // A negative time or one with a billion nanoseconds cannot occur for a thread.
    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default().as_secs_f64()
}

/// Elapsed time (s), for systems whose threads have no clock. Only differences are meaningful.
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
