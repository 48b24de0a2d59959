//! The measured speed of a device.

use std::fmt;

use crate::sensor::BusClock;

/// The measured speed of a device.
pub struct Device<'d> {
    /// Clock of each bus. A bus without one is not compared.
    pub clocks: Vec<BusClock>,
    /// Largest lateness of a thread of the loop (s).
    pub lateness: f64,
    /// Time of one operation of the machine (s).
    pub operation: f64,
    /// Longest measured tick (s) that takes this number of rounds.
    pub tick: Box<dyn FnMut(u32) -> f64 + 'd>,
}

impl Device<'_> {
    /// A device that needs no time. Emulated time is like this.
    #[must_use]
    pub fn instant() -> Self {
        Self { clocks: Vec::new(), lateness: 0.0, operation: 0.0, tick: Box::new(|_| 0.0) }
    }
}

impl fmt::Debug for Device<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { clocks, lateness, operation, tick: _ } = self;
        let mut debug = formatter.debug_struct("Device");
        debug.field("clocks", clocks).field("lateness", lateness).field("operation", operation);
        debug.finish_non_exhaustive()
    }
}
