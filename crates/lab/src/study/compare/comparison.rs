//! All figures of several policies over the same runs.

use crate::results::Document;
use serde::Serialize;

use crate::results::{Ending, Rate, RunResult};

use super::difference::FigureComparison;
use super::figure;

/// Several policies over the same runs: every scenario from every start, with the same noise.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Comparison {
    /// The policies in the order given. The others are compared with the first.
    pub policies: Vec<PolicyRuns>,
    /// Every figure of every other policy that has pairs of runs.
    pub figures: Vec<FigureComparison>,
}

impl Document for Comparison {
    const FORMAT: &'static str = "comparison";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// The runs of one policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PolicyRuns {
    /// The policy's file.
    pub policy: String,
    /// Number of runs.
    pub runs: usize,
    /// Rate of runs that completed: they met their stop condition and the expectations of their scenario. `None` without
    /// runs.
    pub completed: Option<Rate>,
    /// Rate of runs in which the body touched nothing.
    pub collision_free: Option<Rate>,
    /// The runs that did not complete. If such a run did not meet its stop condition, only `completed` counts of its
    /// figures, because the others of a shortened run would mislead.
    pub incomplete: Vec<Incomplete>,
}

/// A run that did not complete.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Incomplete {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of its noise and its start.
    pub seed: u64,
    /// The outcome.
    pub outcome: Ending,
    /// The reason of the outcome. Of a run that ended, the expectations that do not hold.
    pub reason: Option<String>,
}

impl Comparison {
    /// Compares policies by their runs. All policies have the same runs in the same order.
    #[must_use]
    pub fn new(policies: &[(String, Vec<RunResult>)]) -> Self {
        let runs = policies.iter().map(|(policy, results)| {
            let incomplete = results.iter().filter(|result| result.outcome != Ending::Completed);
            let rate = |counts: fn(&RunResult) -> bool| {
                Rate::new(results.iter().filter(|result| counts(result)).count(), results.len())
            };
            PolicyRuns {
                policy: policy.clone(),
                runs: results.len(),
                completed: rate(|result| result.outcome == Ending::Completed),
                collision_free: rate(|result| !result.collided()),
                incomplete: incomplete
                    .map(|result| Incomplete {
                        scenario: result.scenario.clone(),
                        seed: result.seed,
                        outcome: result.outcome,
                        reason: result.explanation(),
                    })
                    .collect(),
            }
        });
        let others = policies.get(1..).unwrap_or_default();
        let figures = policies.first().into_iter().flat_map(|(_, first)| {
            figure::figures().into_iter().flat_map(move |figure| {
                others.iter().filter_map(move |(policy, results)| {
                    let both = first.iter().zip(results);
                    let pairs = both.filter_map(|(a, b)| Some((figure.of(a)?, figure.of(b)?))).collect();
                    FigureComparison::new(&figure, policy, pairs)
                })
            })
        });
        Self { policies: runs.collect(), figures: figures.collect() }
    }
}
