//! Header of a file of sweep results.

use crate::results::Document;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::shard::Shard;

/// The first line of a file of results: everything that the results depend on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Header {
    /// The name of the sweep, or of another command that runs many trials.
    pub sweep: String,
    /// The part of the sweep.
    pub shard: Shard,
    /// Text of the sweep, which defines the list of runs. Empty for another command.
    pub text: String,
    /// The files that the sweep names, and the program, each with its version or a hash of its content.
    pub inputs: BTreeMap<String, String>,
}

impl Document for Header {
    const FORMAT: &'static str = "sweep";
}

impl Header {
    /// The header of the results of a command that is no sweep.
    #[must_use]
    pub fn new(command: &str, inputs: impl IntoIterator<Item = (String, String)>) -> Self {
        let (sweep, text) = (command.to_owned(), String::new());
        Self { sweep, shard: Shard::WHOLE, text, inputs: inputs.into_iter().collect() }
    }

    /// The header of another part.
    #[must_use]
    pub(super) fn of_shard(&self, shard: Shard) -> Self {
        Self { shard, ..self.clone() }
    }

    /// A hash of the header without the part.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        let hash = Sha256::new().chain_update(&self.text);
        let hash = self.inputs.iter().fold(hash, |hash, (name, value)| hash.chain_update(format!("\0{name}\0{value}")));
        hash.finalize().iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"))
    }

    /// A description of the difference from `other`. `None` if both are of the same sweep.
    #[must_use]
    pub(super) fn difference(&self, other: &Self) -> Option<String> {
        if self.sweep != other.sweep {
            return Some(format!("`{}`, these are those of `{}`", self.sweep, other.sweep));
        }
        if self.text != other.text {
            return Some(format!("another text of the sweep `{}`", self.sweep));
        }
        let names = self.inputs.keys().chain(other.inputs.keys());
        names.into_iter().find(|name| self.inputs.get(*name) != other.inputs.get(*name)).map(|name| {
            let version = |header: &Self| header.inputs.get(name).cloned().unwrap_or_else(|| "none".to_owned());
            format!("another version of {name} ({}, now {})", version(self), version(other))
        })
    }
}
