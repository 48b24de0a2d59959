//! Summary of a sweep.

use crate::results::Document;
use std::collections::BTreeMap;

use serde::Serialize;

use crate::results::{Figures, Tally};
use crate::sweep::{Sweep, SweepRun};

/// Summary of a sweep, or of a part of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepSummary {
    /// The name of the sweep.
    pub sweep: String,
    /// Number of runs that earlier processes had finished.
    pub resumed: usize,
    /// Its runs in groups, in the order of the sweep.
    pub groups: Vec<SweepGroup>,
    /// Counts over the values of each axis for each policy, over all scenes and all values of the other axes.
    pub curves: Vec<SweepCurve>,
}

/// The runs of one policy over the values of one axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepCurve {
    /// The axis.
    pub axis: String,
    /// The policy.
    pub policy: String,
    /// Its values in the order of the sweep.
    pub points: Vec<SweepPoint>,
}

/// The runs of one policy with one value of an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepPoint {
    /// The value as written in the sweep.
    pub value: String,
    /// Counts over the runs.
    #[serde(flatten)]
    pub tally: Tally,
}

impl Document for SweepSummary {
    const FORMAT: &'static str = "sweep-summary";
}

/// The runs of one family or scenario under one policy, with one value of every axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepGroup {
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
    pub fn new(sweep: &Sweep, runs: &BTreeMap<u64, Figures>, resumed: usize) -> Self {
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
        Self { sweep: sweep.name.clone(), resumed, groups: groups.collect(), curves: curves(sweep, runs) }
    }

    /// Number of runs that crashed or could not begin.
    #[must_use]
    pub fn without_result(&self) -> usize {
        self.groups.iter().map(|group| group.tally.crashed + group.tally.refused).sum()
    }
}

/// The curves of all axes with several values, by axis and then by policy.
fn curves(sweep: &Sweep, runs: &BTreeMap<u64, Figures>) -> Vec<SweepCurve> {
    let mut figures_of: BTreeMap<(String, usize, String), Vec<Figures>> = BTreeMap::new();
    // The values of an axis are in the order of their first runs, which is that of the sweep.
    let mut values: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let known = runs.iter().filter_map(|(&index, &figures)| Some((sweep.run(index)?, figures)));
    for (run, figures) in known {
        for (axis, value) in run.settings() {
            let of_axis = values.entry(axis.to_owned()).or_default();
            if !of_axis.contains(&value) {
                of_axis.push(value.clone());
            }
            figures_of.entry((axis.to_owned(), run.policy, value)).or_default().push(figures);
        }
    }
    let mut curves = Vec::new();
    for (axis, values) in values.into_iter().filter(|(_, values)| values.len() > 1) {
        for (index, policy) in sweep.policies.iter().enumerate() {
            let point = |value: &String| {
                let runs = figures_of.remove(&(axis.clone(), index, value.clone()))?;
                Some(SweepPoint { value: value.clone(), tally: Tally::new(runs) })
            };
            let points = values.iter().filter_map(point).collect();
            curves.push(SweepCurve { axis: axis.clone(), policy: policy.name.clone(), points });
        }
    }
    curves
}
