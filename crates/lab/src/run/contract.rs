//! What a run observed of a contract of its policy.

use std::fmt;

use vibrissa_runtime::machine::{ObservedContract, Program};
use vibrissa_runtime::units::{Dimension, format_si};

/// What a run observed of a contract of its policy.
#[derive(Debug, Clone, PartialEq)]
pub struct ContractRecord {
    /// Name of the state. `None` for a contract of the whole machine.
    pub state: Option<String>,
    /// The contract, as written.
    pub text: String,
    /// Number of evaluations. 0 if the state was never active.
    pub evaluations: u64,
    /// Number of evaluations that found a violation.
    pub violations: u64,
    /// Time (s) of the first violation.
    pub first_violation: Option<f64>,
    /// The smallest margin, if the contract has one.
    pub margin: Option<ContractMargin>,
}

/// The smallest distance of the compared numbers from a violation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContractMargin {
    /// The distance (SI). It is negative in a violation.
    pub margin: f64,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its time (s).
    pub time: f64,
}

/// For a violated contract, its state, the number of ticks, the first time and the smallest margin.
impl fmt::Display for ContractRecord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(state) = &self.state {
            write!(f, "state {state}: ")?;
        }
        let ticks = if self.violations == 1 { "tick" } else { "ticks" };
        write!(f, "violated `{}` in {} {ticks}", self.text, self.violations)?;
        if let Some(time) = self.first_violation {
            write!(f, ", first at {time:.2} s")?;
        }
        if let Some(ContractMargin { margin, dimension, time }) = self.margin {
            write!(f, ", smallest margin {} at {time:.2} s", format_si(margin, dimension))?;
        }
        Ok(())
    }
}

impl ContractRecord {
    /// The record of an observed contract of `program`.
    #[must_use]
    pub fn new(program: &Program, observed: &ObservedContract<'_>) -> Self {
        let ObservedContract { state, contract, status } = *observed;
        let state = state.and_then(|state| program.states.get(state));
        let margin = contract.margin.zip(status.smallest_margin);
        Self {
            state: state.map(|state| state.name.to_string()),
            text: contract.text.to_string(),
            evaluations: status.evaluations,
            violations: status.violations,
            first_violation: status.first_violation,
            margin: margin.map(|((_, dimension), smallest)| ContractMargin {
                margin: smallest.margin,
                dimension,
                time: smallest.time,
            }),
        }
    }
}
