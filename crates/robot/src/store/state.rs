//! The state of a store: which machines it has, and which one runs.

use std::fmt;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use super::machine_hash::MachineHash;
use super::text::one_line;

/// Maximum length of a reason in characters.
const REASON_LIMIT: usize = 500;

/// The machines of a store.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// The last machine that was marked good.
    pub good: Option<MachineHash>,
    /// The machine that was pushed last, until it is marked good or given up.
    pub tentative: Option<Tentative>,
    /// The last machine that was given up.
    pub rejected: Option<Rejection>,
    /// Older machines, which a state of an older version names. They are not kept.
    #[serde(default, rename = "previous", skip_serializing)]
    _previous: IgnoredAny,
    /// The largest counter of a machine that was marked good. A machine with a smaller one, or with none, is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counter: Option<u64>,
}

/// A machine that has not yet been marked good.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tentative {
    /// The machine.
    pub hash: MachineHash,
    /// Number of its starts.
    pub starts: u32,
}

/// A machine that was given up.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rejection {
    /// The machine.
    pub hash: MachineHash,
    /// The reason, one line.
    pub reason: String,
}

/// The role of a machine that may run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// It was marked good.
    Good,
    /// It was pushed and not yet marked good.
    Tentative,
}

impl State {
    /// The machine to run: the tentative one, or else the good one.
    #[must_use]
    pub fn current(&self) -> Option<(MachineHash, Role)> {
        let tentative = self.tentative.map(|tentative| (tentative.hash, Role::Tentative));
        tentative.or(self.good.map(|hash| (hash, Role::Good)))
    }

    /// All machines that are kept.
    pub(super) fn kept(&self) -> impl Iterator<Item = MachineHash> {
        self.good.into_iter().chain(self.tentative.map(|tentative| tentative.hash))
    }

    /// True if no machine has two roles.
    pub(super) fn is_consistent(&self) -> bool {
        self.tentative.is_none_or(|tentative| self.good != Some(tentative.hash))
    }

    /// Makes a new machine tentative, with no start. If it is the good one, the tentative one is withdrawn instead.
    pub(super) fn receive(&mut self, hash: MachineHash) -> Role {
        self.rejected.take_if(|rejected| rejected.hash == hash);
        let is_good = self.good == Some(hash);
        self.tentative = (!is_good).then_some(Tentative { hash, starts: 0 });
        if is_good { Role::Good } else { Role::Tentative }
    }

    /// Takes back a start of the tentative machine. Returns false if `hash` is not the tentative one.
    pub(super) fn undo_start(&mut self, hash: MachineHash) -> bool {
        match &mut self.tentative {
            Some(tentative) if tentative.hash == hash => {
                tentative.starts = tentative.starts.saturating_sub(1);
                true
            }
            _ => false,
        }
    }

    /// Makes the tentative machine the good one. Returns false if `hash` is neither the tentative nor the good one.
    pub(super) fn mark_good(&mut self, hash: MachineHash) -> bool {
        if self.good == Some(hash) {
            return true;
        }
        if self.tentative.is_none_or(|tentative| tentative.hash != hash) {
            return false;
        }
        self.tentative = None;
        self.good = Some(hash);
        true
    }

    /// Gives the tentative machine up. Returns false if `hash` is not the tentative one.
    pub(super) fn reject(&mut self, hash: MachineHash, reason: &str) -> bool {
        if self.tentative.is_none_or(|tentative| tentative.hash != hash) {
            return false;
        }
        self.tentative = None;
        self.rejected = Some(Rejection { hash, reason: one_line(reason, REASON_LIMIT) });
        true
    }
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.hash, self.reason)
    }
}
