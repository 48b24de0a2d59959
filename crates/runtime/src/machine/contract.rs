//! Contracts: conditions that a policy states about its states. A machine watches them while it runs.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::units::Dimension;

use super::activity::TIME_SLACK;
use super::op::{Block, Register};

/// Maximum number of contracts of a program.
pub const CONTRACT_LIMIT: usize = 1_000;

/// A condition that a policy states about a state or about the whole machine.
///
/// A contract has no effect on the machine. It sees the same values as the guards of its state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contract {
    /// The moments at which it is evaluated.
    pub moment: Moment,
    /// Its text in the policy, on one line of at most [`DESCRIPTION_LIMIT`](super::DESCRIPTION_LIMIT) bytes:
    /// `never w.tip_deviation > 2 mm for 1 s`.
    pub text: Arc<str>,
    /// Code of its condition.
    pub code: Block,
    /// Register of a bool: true if the contract is violated, apart from the duration.
    pub violated: Register,
    /// Register of the duration (s) for which the bool must be true without interruption, if there is one.
    pub lasting: Option<Register>,
    /// Register and dimension of the distance (SI) of the compared numbers from a violation. It is negative in a violation.
    /// `None` if the condition compares different dimensions or bools.
    pub margin: Option<(Register, Dimension)>,
}

/// The moments at which a contract is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Moment {
    /// When its state is entered, or when the machine starts.
    Entry,
    /// In every tick in which its state is active, after the transitions.
    Tick,
}

/// What a machine has observed of a contract.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContractStatus {
    /// Number of evaluations.
    pub evaluations: u64,
    /// Number of evaluations that found a violation.
    pub violations: u64,
    /// Time (s) of the first violation.
    pub first_violation: Option<f64>,
    /// Time (s) since which the condition is violated without interruption.
    violated_since: Option<f64>,
    /// True if the newest evaluation found a violation.
    is_violated: bool,
    /// The smallest margin, if the contract has one.
    pub smallest_margin: Option<TimedMargin>,
}

/// A margin and its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedMargin {
    /// The margin (SI), as in [`Contract::margin`].
    pub margin: f64,
    /// The time (s).
    pub time: f64,
}

impl ContractStatus {
    /// Forgets since when the condition is violated, because the state is entered again.
    pub(super) fn restart(&mut self) {
        (self.violated_since, self.is_violated) = (None, false);
    }

    /// Adds the evaluation of `contract` at the time `now` (s). The result is `None` without a violation, and otherwise tells
    /// whether it begins now.
    pub(super) fn update(&mut self, contract: &Contract, registers: &[f64], now: f64) -> Option<bool> {
        let value = |register: Register| registers[usize::from(register)];
        self.evaluations += 1;
        if let Some((register, _)) = contract.margin {
            let margin = value(register);
            // A margin that is not a number is that of a comparison that does not hold.
            if self.smallest_margin.is_none_or(|smallest| margin < smallest.margin) && !margin.is_nan() {
                self.smallest_margin = Some(TimedMargin { margin, time: now });
            }
        }
        if value(contract.violated) <= 0.5 {
            (self.violated_since, self.is_violated) = (None, false);
            return None;
        }
        let since = *self.violated_since.get_or_insert(now);
        let was_violated = self.is_violated;
        self.is_violated = contract.lasting.is_none_or(|lasting| now - since >= value(lasting) - TIME_SLACK);
        if !self.is_violated {
            return None;
        }
        self.violations += 1;
        self.first_violation.get_or_insert(now);
        Some(!was_violated)
    }
}

/// A contract of a machine and what was observed of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObservedContract<'m> {
    /// Index of its state. `None` for a contract of the whole machine.
    pub state: Option<usize>,
    /// The contract.
    pub contract: &'m Contract,
    /// What was observed.
    pub status: &'m ContractStatus,
}
