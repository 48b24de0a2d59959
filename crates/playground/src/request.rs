//! What the page asks for.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value;
use vibrissa_lab::stream::message::CounterfactualKind;

use crate::shapes::Change;

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
        /// The texts of the breakpoints, of which the run has those that its policy can have.
        #[serde(default)]
        breakpoints: Vec<String>,
        /// True for a run beside the one that the page shows.
        #[serde(default)]
        beside: bool,
    },
    /// Replaces the breakpoints. The answer has those that the policy can have.
    Break {
        /// Their texts.
        texts: Vec<String>,
        /// The one of them that the policy must have.
        new: Option<String>,
    },
    /// Begins a counterfactual. An earlier one is forgotten.
    Counterfactual {
        /// Its number.
        id: u64,
        /// The first tick with the change.
        tick: usize,
        /// The kind.
        kind: CounterfactualKind,
        /// The changed values (SI).
        set: BTreeMap<String, f64>,
    },
    /// Executes ticks of the counterfactual. The answer is its next piece, or null until that is full.
    Answer {
        /// Their largest number.
        ticks: usize,
    },
    /// Draws a scene of a family. The answer has the text of its scenario and the speed (m/s) of its run.
    Draw {
        /// The name of the family.
        family: String,
        /// The number of the scene.
        number: u64,
    },
    /// The objects of a scenario.
    Shapes {
        /// The text of the scenario.
        scenario: String,
    },
    /// Changes an object of a scenario. The answer has the new text.
    Reshape {
        /// The text of the scenario.
        scenario: String,
        /// The change.
        change: Change,
    },
    /// Simulates ticks.
    Advance {
        /// Their largest number.
        ticks: usize,
        /// False if nobody watches. Then no frames are made.
        #[serde(default = "yes")]
        frames: bool,
        /// True for the run beside the one that the page shows.
        #[serde(default)]
        beside: bool,
    },
    /// The frames of the run that the page shows, which were made since this was asked last.
    Frames,
    /// The ticks of the run until now, as `run --ticks` writes them.
    Ticks,
    /// Scores the run, which has ended. Then its ticks are gone.
    Score {
        /// True for the run beside the one that the page shows.
        #[serde(default)]
        beside: bool,
    },
}

fn yes() -> bool {
    true
}
