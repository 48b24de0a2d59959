//! Contracts of the machine that begin to be violated in a tick.

use vibrissa_runtime::machine::{ContractId, Observer, ViolatedContract};

/// Maximum number of contracts that are reported for one tick.
const LIMIT: usize = 8;

/// Observes a tick, and keeps the contracts that begin to be violated in it. It allocates no memory.
#[derive(Debug, Default)]
pub(super) struct NewViolations {
    found: [Option<ContractId>; LIMIT],
}

impl NewViolations {
    /// The contracts, at most eight.
    pub(super) fn contracts(&self) -> impl Iterator<Item = ContractId> {
        self.found.iter().copied().flatten()
    }
}

impl Observer for NewViolations {
    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        if violated.is_new
            && let Some(free) = self.found.iter_mut().find(|found| found.is_none())
        {
            *free = Some(violated.id);
        }
    }
}
