//! Elapsed wall time, where there is a clock.

use std::time::Duration;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use std::time::Instant;

/// Measures wall time. In a browser the standard library has no clock, so all times are zero there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stopwatch {
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    started: Instant,
}

impl Stopwatch {
    /// A stopwatch that starts now.
    pub(crate) fn start() -> Self {
        Self {
            #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
            started: Instant::now(),
        }
    }

    /// The time since the start.
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    pub(crate) fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// The time since the start, which is not known.
    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    #[expect(clippy::unused_self, reason = "elsewhere it has a start")]
    pub(crate) fn elapsed(&self) -> Duration {
        Duration::ZERO
    }
}
