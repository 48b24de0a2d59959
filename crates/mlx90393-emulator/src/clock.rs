//! Virtual time.

use embedded_hal::delay::DelayNs;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A virtual clock. Clones share the same time, so a clock can be read while its bus is borrowed.
///
/// As a [`DelayNs`], it advances by the delay and returns at once.
#[derive(Debug, Clone, Default)]
pub struct EmulatedClock(Arc<AtomicU64>);

impl EmulatedClock {
    /// Creates a clock at time 0.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The time (ns).
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// Advances the time by a duration (ns).
    pub fn advance_ns(&self, duration_ns: u64) {
        self.0.fetch_add(duration_ns, Ordering::Relaxed);
    }

    /// Advances the time to a value (ns). The time never goes back, so an earlier value has no effect.
    pub fn advance_to_ns(&self, time_ns: u64) {
        self.0.fetch_max(time_ns, Ordering::Relaxed);
    }
}

impl DelayNs for EmulatedClock {
    fn delay_ns(&mut self, ns: u32) {
        self.advance_ns(u64::from(ns));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_a_time_that_never_goes_back() {
        let clock = EmulatedClock::new();
        clock.clone().delay_us(3);
        assert_eq!(clock.now_ns(), 3_000);
        clock.advance_to_ns(2_000);
        assert_eq!(clock.now_ns(), 3_000);
        clock.advance_to_ns(4_000);
        assert_eq!(clock.now_ns(), 4_000);
    }
}
