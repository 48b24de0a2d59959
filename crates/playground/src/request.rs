//! What the page asks for.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value;

/// A request of the page.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Request {
    /// The texts of the built-in scenarios and policies.
    Catalog,
    /// A message of the Language Server Protocol.
    Language {
        /// The message.
        message: Value,
    },
    /// Begins a run. An earlier one is forgotten.
    Start {
        /// The text of the scenario.
        scenario: String,
        /// The text of the policy.
        policy: String,
        /// Other values (SI) of parameters and thresholds, by the names in the first message of the run before.
        #[serde(default)]
        set: BTreeMap<String, f64>,
    },
    /// Simulates ticks.
    Advance {
        /// Their largest number.
        ticks: usize,
        /// False if nobody watches. Then the answer has no frames.
        #[serde(default = "yes")]
        frames: bool,
    },
    /// Scores the run, which has ended.
    Score,
}

fn yes() -> bool {
    true
}
