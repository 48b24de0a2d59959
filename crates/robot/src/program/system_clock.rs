//! The monotonic clock of the system.

use rustix::thread::{ClockId, clock_nanosleep_absolute};
use rustix::time::{Timespec, clock_gettime};

/// The monotonic clock, counted from the start of the program. All threads share one start.
#[derive(Debug, Clone, Copy)]
pub struct SystemClock {
    start: Timespec,
}

const NS_PER_S: i64 = 1_000_000_000;

impl SystemClock {
    /// A clock that starts now.
    #[must_use]
    pub fn start() -> Self {
        Self { start: clock_gettime(rustix::time::ClockId::Monotonic) }
    }

    /// Time since the start (ns).
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        let now = clock_gettime(rustix::time::ClockId::Monotonic);
        let ns = (now.tv_sec - self.start.tv_sec) * NS_PER_S + now.tv_nsec - self.start.tv_nsec;
        u64::try_from(ns).unwrap_or(0)
    }

    /// Sleeps until a time since the start (ns). A signal does not shorten the sleep.
    pub fn sleep_until_ns(&self, time_ns: u64) {
        let ns = self.start.tv_nsec + i64::try_from(time_ns).unwrap_or(i64::MAX / 2);
        let until = Timespec { tv_sec: self.start.tv_sec + ns / NS_PER_S, tv_nsec: ns % NS_PER_S };
        while clock_nanosleep_absolute(ClockId::Monotonic, &until).is_err_and(|error| error == rustix::io::Errno::INTR)
        {
        }
    }
}
