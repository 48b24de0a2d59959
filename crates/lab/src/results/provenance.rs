//! The origin of a result: how it was made, by what, and from what.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::CalibrationKind;

/// The origin of a result. Documents of equal runs are equal but for this and for measured times.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Provenance {
    /// The command, quoted for a shell. Given again in the same directory, it repeats the result. Its output goes to a path of
    /// its own, so that the first result stays.
    pub command: String,
    /// Version of the program.
    pub version: String,
    /// Commit of the program's sources, `modified` if they differed from it. `None` if it is unknown.
    pub commit: Option<String>,
    /// The time of the command in UTC (RFC 3339).
    pub date: String,
    /// The simulators of the runs. Empty without runs.
    pub simulators: Vec<Simulator>,
    /// The scenes of the runs, or the families that they were drawn from.
    pub scenes: Vec<String>,
    /// The policies of the runs.
    pub policies: Vec<String>,
    /// The seeds of noise and starts.
    pub seeds: Vec<SeedRange>,
    /// Largest deviations of starts. `None` if no start was displaced.
    pub jitter: Option<JitterRecord>,
    /// The mismatches between simulated and assumed arrays. Empty without any.
    pub mismatches: Vec<MismatchRecord>,
    /// What control assumed of the arrays that differ from those of the scenes, or that are calibrated. Each run names its calibration.
    pub calibrations: Vec<CalibrationKind>,
    /// Hashes of what the runs were made from. Empty without runs.
    #[serde(default)]
    pub hashes: InputHashes,
}

/// Hashes of the inputs of runs, as in the key `hash` of a run.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InputHashes {
    /// Of the policies with their libraries and parameters, each once.
    pub policies: Vec<InputHash>,
    /// Of the scenarios with their files and their mismatch, each in its first run. Further starts and seeds of a mismatch have
    /// hashes of their own.
    pub scenarios: Vec<InputHash>,
}

/// The hash of an input.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InputHash {
    /// Name of the policy or scenario.
    pub name: String,
    /// Its hash.
    pub hash: String,
}

/// A simulator.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Simulator {
    /// Its name, as in `--simulator`.
    pub name: String,
    /// Its version.
    pub version: String,
}

/// Consecutive seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SeedRange {
    /// The first seed.
    pub first: u64,
    /// The last seed.
    pub last: u64,
}

/// Largest deviations of starts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JitterRecord {
    /// Along x and along y.
    pub position_m: f64,
    /// Of the heading.
    pub heading_rad: f64,
}

/// A mismatch of some runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MismatchRecord {
    /// Path of its file. `None` if scenarios alone have it.
    pub file: Option<String>,
    /// The seeds of drawn values. Empty if no value is a range.
    pub seeds: Vec<SeedRange>,
}

/// What a run adds to the origin of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct RunOrigin<'r> {
    /// Name of its scenario.
    pub scenario: &'r str,
    /// Name of its policy.
    pub policy: &'r str,
    /// Its simulator.
    pub simulator: Simulator,
    /// Seed of its noise.
    pub seed: u64,
    /// Its mismatch, with an empty list of seeds, and the seed of drawn values. The seed is `None` if no value is a range.
    pub mismatch: Option<(MismatchRecord, Option<u64>)>,
    /// Its calibration.
    pub calibration: Option<CalibrationKind>,
    /// Hash of its scenario.
    pub scenario_hash: &'r str,
    /// Hash of its policy.
    pub policy_hash: &'r str,
}

impl Provenance {
    /// Adds a run. Names and seeds are kept once.
    pub fn add(&mut self, run: RunOrigin<'_>) {
        let RunOrigin { scenario, policy, simulator, seed, mismatch, calibration, scenario_hash, policy_hash } = run;
        self.hashes.add(scenario, scenario_hash, policy, policy_hash);
        self.add_scene(scenario);
        self.add_policy(policy);
        self.add_simulator(simulator);
        add_seed(&mut self.seeds, seed);
        self.calibrations.extend(calibration.filter(|kind| !self.calibrations.contains(kind)));
        let Some((mismatch, seed)) = mismatch else { return };
        if self.mismatches.iter().all(|known| known.file != mismatch.file) {
            self.mismatches.push(mismatch.clone());
        }
        let known = self.mismatches.iter_mut().filter(|known| known.file == mismatch.file);
        for (known, seed) in known.zip(seed) {
            add_seed(&mut known.seeds, seed);
        }
    }

    /// Adds a scene, unless it is there.
    pub fn add_scene(&mut self, scene: &str) {
        add(&mut self.scenes, scene);
    }

    /// Adds a policy, unless it is there.
    pub fn add_policy(&mut self, policy: &str) {
        add(&mut self.policies, policy);
    }

    /// Adds a simulator, unless it is there.
    pub fn add_simulator(&mut self, simulator: Simulator) {
        if !self.simulators.contains(&simulator) {
            self.simulators.push(simulator);
        }
    }
}

impl InputHashes {
    fn add(&mut self, scenario: &str, scenario_hash: &str, policy: &str, policy_hash: &str) {
        if self.scenarios.iter().all(|known| known.name != scenario) {
            self.scenarios.push(InputHash { name: scenario.to_owned(), hash: scenario_hash.to_owned() });
        }
        let policy = InputHash { name: policy.to_owned(), hash: policy_hash.to_owned() };
        if !self.policies.contains(&policy) {
            self.policies.push(policy);
        }
    }
}

fn add(names: &mut Vec<String>, name: &str) {
    if names.iter().all(|known| known != name) {
        names.push(name.to_owned());
    }
}

/// Adds a seed to ranges in increasing order. Neighbouring ranges are joined.
pub fn add_seed(ranges: &mut Vec<SeedRange>, seed: u64) {
    add_seeds(ranges, SeedRange { first: seed, last: seed });
}

/// Adds seeds to ranges in increasing order. Neighbouring ranges are joined.
pub fn add_seeds(ranges: &mut Vec<SeedRange>, added: SeedRange) {
    let begin = ranges.partition_point(|range| range.last.saturating_add(1) < added.first);
    let end = ranges.partition_point(|range| range.first <= added.last.saturating_add(1));
    let touching = ranges.get(begin..end).unwrap_or_default();
    let joined = touching.iter().fold(added, |joined, range| SeedRange {
        first: joined.first.min(range.first),
        last: joined.last.max(range.last),
    });
    ranges.splice(begin..end.max(begin), [joined]);
}

impl fmt::Display for SeedRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.first == self.last { write!(f, "{}", self.first) } else { write!(f, "{} to {}", self.first, self.last) }
    }
}

impl fmt::Display for Simulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name, self.version)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ranges_have_exactly_the_seeds_that_were_added(seeds in prop::collection::vec(0..30_u64, 0..20)) {
            let mut ranges = Vec::new();
            for &seed in &seeds {
                add_seed(&mut ranges, seed);
            }
            let found: Vec<u64> = ranges.iter().flat_map(|range| range.first..=range.last).collect();
            let mut seeds = seeds;
            seeds.sort_unstable();
            seeds.dedup();
            prop_assert_eq!(found, seeds);
            prop_assert!(ranges.windows(2).all(|pair| pair[0].last + 1 < pair[1].first));
        }
    }

    #[test]
    fn the_largest_seed_is_a_range_too() {
        let mut ranges = Vec::new();
        for seed in [u64::MAX, u64::MAX - 1, 0] {
            add_seed(&mut ranges, seed);
        }
        let texts: Vec<String> = ranges.iter().map(SeedRange::to_string).collect();
        assert_eq!(texts, ["0", "18446744073709551614 to 18446744073709551615"]);
    }
}
