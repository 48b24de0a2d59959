//! A part of a sweep.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// One of several parts of a sweep. The part of a run depends only on its key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    /// Number of the part, from 1.
    number: u64,
    /// Number of parts.
    of: u64,
}

impl Shard {
    /// All of a sweep, in one part.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// True if the run with this key belongs to the part.
    #[must_use]
    pub fn has(self, key: &str) -> bool {
        run_hash(key) % self.of == self.number - 1
    }

    /// The part of the run with this key, of the same number of parts.
    #[must_use]
    pub fn of_run(self, key: &str) -> Self {
        Self { number: run_hash(key) % self.of + 1, of: self.of }
    }

    /// Name of the file of its results.
    #[must_use]
    pub fn file_name(self) -> String {
        if self == Self::WHOLE {
            "results.jsonl".to_owned()
        } else {
            format!("shard-{}-of-{}.jsonl", self.number, self.of)
        }
    }
}

/// The name of a run: the hash of its key in hexadecimal digits.
pub(super) fn run_name(key: &str) -> String {
    format!("{:016x}", run_hash(key))
}

/// The hash of a run's key.
pub(super) fn run_hash(key: &str) -> u64 {
    Sha256::digest(key).iter().take(8).fold(0, |hash, &byte| hash << 8 | u64::from(byte))
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse().ok().filter(|number| (1..=1_000_000).contains(number));
        let shard = text.split_once('/').and_then(|(shard, of)| Some(Self { number: number(shard)?, of: number(of)? }));
        let shard = shard.filter(|shard| shard.number <= shard.of);
        shard.ok_or_else(|| "write K/N, the K-th of N parts, such as 1/8 to 8/8".to_owned())
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn every_run_belongs_to_one_shard_and_shards_are_about_equal() {
        let shards: Vec<Shard> = (1..=7).map(|number| format!("{number}/7").parse().unwrap()).collect();
        let mut counts = [0; 7];
        for trial in 0..7000 {
            let key = format!("family=polygon, trial={trial}, policy=vibrissa");
            let owners: Vec<_> = (0..7).filter(|&index| shards[index].has(&key)).collect();
            assert_eq!(owners.len(), 1, "{key}");
            assert_eq!(Shard::WHOLE.of_run(&key), Shard::WHOLE);
            assert_eq!(shards[0].of_run(&key), shards[owners[0]]);
            counts[owners[0]] += 1;
        }
        // Six standard deviations of a thousand.
        assert!(counts.iter().all(|count| (820..1180).contains(count)), "{counts:?}");
    }

    #[test]
    fn a_shard_that_cannot_be_is_refused() {
        for text in ["0/3", "4/3", "1", "1/0", "-1/3", "a/b", "1/3/5", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
        assert_eq!("3/8".parse::<Shard>().unwrap().to_string(), "3/8");
    }
}
