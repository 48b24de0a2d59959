//! An injection and its progress.

use super::injection::Injection;

/// An injection and its progress.
#[derive(Debug, Clone, Copy)]
pub(super) struct PendingInjection {
    pub(super) injection: Injection,
    pub(super) is_injected: bool,
    pub(super) is_cleared: bool,
}

impl PendingInjection {
    pub(super) fn new(injection: Injection) -> Self {
        Self { injection, is_injected: false, is_cleared: false }
    }

    /// Time (ns) of the next change, if there is one.
    pub(super) fn due_ns(&self, begun_ns: u64) -> Option<u64> {
        let Injection { at_ms, for_ms, .. } = self.injection;
        let at_ns = begun_ns.saturating_add(at_ms.saturating_mul(1_000_000));
        match (self.is_injected, self.is_cleared) {
            (false, _) => Some(at_ns),
            (true, false) => Some(at_ns.saturating_add(for_ms.saturating_mul(1_000_000))),
            (true, true) => None,
        }
    }
}
