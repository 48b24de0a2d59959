//! Summary of a sweep.

use crate::results::Document;
use std::collections::BTreeMap;

use serde::Serialize;

use crate::results::{Figures, Tally};
use crate::sweep::{Sweep, SweepRun};

/// Summary of a sweep, or of a part of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SweepSummary {
    /// The name of the sweep.
    pub sweep: String,
    /// Number of runs that earlier processes had finished.
    pub resumed: usize,
    /// Its runs in groups, in the order of the sweep.
    pub groups: Vec<SweepGroup>,
}

impl Document for SweepSummary {
    const FORMAT: &'static str = "sweep-summary";
}

/// The runs of one family or scenario under one policy, with one value of every axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SweepGroup {
    /// The family or the scenario.
    pub scenes: String,
    /// The values of the axes as written in the sweep.
    pub settings: BTreeMap<String, String>,
    /// The policy.
    pub policy: String,
    /// Counts over the runs.
    #[serde(flatten)]
    pub tally: Tally,
}

impl SweepSummary {
    /// Counts runs of `sweep` by their indices. `resumed` of them are from earlier processes.
    #[must_use]
    pub(crate) fn new(sweep: &Sweep, runs: &BTreeMap<u64, Figures>, resumed: usize) -> Self {
        let mut groups: BTreeMap<_, (SweepRun<'_>, Vec<Figures>)> = BTreeMap::new();
        for (&index, &figures) in runs {
            if let Some(run) = sweep.run(index) {
                groups.entry(run.group()).or_insert_with(|| (run, Vec::new())).1.push(figures);
            }
        }
        let groups = groups.into_values().map(|(run, figures)| SweepGroup {
            scenes: run.scenes().name().to_owned(),
            settings: run.settings().map(|(name, value)| (name.to_owned(), value)).collect(),
            policy: run.policy().name.clone(),
            tally: Tally::new(figures),
        });
        Self { sweep: sweep.name().to_owned(), resumed, groups: groups.collect() }
    }

    /// Number of runs that crashed or could not begin.
    #[must_use]
    pub(crate) fn without_result(&self) -> usize {
        self.groups.iter().map(|group| group.tally.crashed + group.tally.refused).sum()
    }
}
