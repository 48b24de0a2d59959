//! A contract of the policy in the result of a run.

use serde::{Deserialize, Serialize};
use vibrissa_runtime::units::format_si;

use crate::run::{ContractMargin, ContractRecord};

/// A contract of the policy in the result of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContractResult {
    /// Name of the state. `None` for a contract of the whole machine.
    pub state: Option<String>,
    /// The contract, as written.
    pub contract: String,
    /// Number of evaluations. 0 if the state was never active.
    pub evaluations: u64,
    /// Number of evaluations that found a violation.
    pub violations: u64,
    /// Time of the first violation.
    pub first_s: Option<f64>,
    /// The smallest distance of the compared numbers from a violation. `None` if they have different dimensions, or if the
    /// contract compares no numbers.
    pub smallest_margin: Option<SmallestMargin>,
}

/// The smallest margin of a contract.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SmallestMargin {
    /// The margin with its unit. It is negative in a violation.
    pub margin: String,
    /// The same in SI units.
    pub margin_si: f64,
    /// Its time.
    pub time_s: f64,
}

impl ContractResult {
    /// The result of a record.
    #[must_use]
    pub fn new(record: &ContractRecord) -> Self {
        let ContractRecord { state, text, evaluations, violations, first_violation, margin } = record;
        Self {
            state: state.clone(),
            contract: text.clone(),
            evaluations: *evaluations,
            violations: *violations,
            first_s: *first_violation,
            smallest_margin: margin.map(|ContractMargin { margin, dimension, time }| SmallestMargin {
                margin: format_si(margin, dimension),
                margin_si: margin,
                time_s: time,
            }),
        }
    }
}
