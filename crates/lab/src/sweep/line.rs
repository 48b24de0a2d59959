//! The result of a run of a sweep, as a line.

use crate::results::Document;
use std::collections::BTreeMap;

use serde::de::Error as _;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::results::{CalibrationIdentity, Ending, Figures, LargestError, RunResult, figure_in};
use crate::sweep::SweepRun;

use super::shard::run_name;
use vibrissa_declare::figures::Metric;

/// The result of a run of a sweep. Its serialised form is a line of the results.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepLine {
    /// Hash of its key, in hexadecimal digits.
    run: String,
    /// Its key.
    key: String,
    /// The family or the scenario.
    scenes: String,
    /// Number of its trial.
    trial: u64,
    /// The values of the axes as written in the sweep.
    settings: BTreeMap<String, String>,
    /// True if all expectations of its scenario hold.
    passed: bool,
    #[serde(flatten)]
    end: End,
}

impl Document for SweepLine {
    const FORMAT: &'static str = "sweep-run";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// The end of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum End {
    Result {
        about: String,
        #[serde(flatten)]
        result: Box<RunResult>,
    },
    NoResult {
        policy: String,
        outcome: Ending,
        reason: String,
    },
}

impl SweepLine {
    /// The line of a run that took place. `about` describes the scene.
    #[must_use]
    pub fn ran(run: &SweepRun<'_>, about: String, result: RunResult) -> Self {
        Self::new(run, result.violations.is_empty(), End::Result { about, result: Box::new(result) })
    }

    /// The line of a run that could not begin.
    #[must_use]
    pub fn refused(run: &SweepRun<'_>, reason: String) -> Self {
        Self::without_result(run, Ending::Refused, reason)
    }

    /// The line of a run whose process crashed.
    #[must_use]
    pub fn crashed(run: &SweepRun<'_>, reason: String) -> Self {
        Self::without_result(run, Ending::Crashed, reason)
    }

    fn without_result(run: &SweepRun<'_>, outcome: Ending, reason: String) -> Self {
        Self::new(run, false, End::NoResult { policy: run.policy().name.clone(), outcome, reason })
    }

    fn new(run: &SweepRun<'_>, passed: bool, end: End) -> Self {
        let key = run.key();
        Self {
            run: run.hash(),
            key,
            scenes: run.scenes().name().to_owned(),
            trial: run.trial,
            settings: run.settings().map(|(name, value)| (name.to_owned(), value)).collect(),
            passed,
            end,
        }
    }
}

/// The result of a run, read from its line.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ReadLine {
    /// Hash of its key, in hexadecimal digits. It is the name of its picture.
    pub run: String,
    /// The key of the run.
    pub key: String,
    scenes: String,
    /// Number of its trial.
    pub trial: u64,
    settings: BTreeMap<String, String>,
    /// True if all expectations of its scenario hold.
    pub passed: bool,
    #[serde(default)]
    passed_but_for_tips: bool,
    /// The outcome.
    pub outcome: Ending,
    /// Reason of the outcome.
    pub reason: Option<String>,
    /// Description of the scene.
    pub about: Option<String>,
    /// The calibration of the array that control assumed.
    pub calibration: Option<CalibrationIdentity>,
    /// The tip estimate with the largest error.
    pub largest_error: Option<LargestError>,
    /// A line of an older program, and one without a result, has none.
    violations: Option<Vec<String>>,
    #[serde(flatten)]
    figures: Value,
}

impl ReadLine {
    /// Descriptions of what did not hold.
    #[must_use]
    pub fn violations(&self) -> &[String] {
        self.violations.as_deref().unwrap_or_default()
    }

    /// A figure in the unit of its key. `None` if the run does not have it.
    pub(crate) fn figure(&self, metric: Metric) -> Option<f64> {
        figure_in(&self.figures, metric)
    }

    /// The figures that are counted.
    #[must_use]
    pub fn figures(&self) -> Figures {
        let Self { passed, passed_but_for_tips, outcome, .. } = *self;
        Figures { passed, passed_but_for_tips, ..Figures::of(outcome, |metric| self.figure(metric)) }
    }

    /// Checks that the line is that of the `run` with its key.
    ///
    /// # Errors
    /// The contradiction.
    pub(super) fn check(&self, run: &SweepRun<'_>) -> Result<(), String> {
        let settings: BTreeMap<_, _> = run.settings().map(|(name, value)| (name.to_owned(), value)).collect();
        let contradicts = [
            ("scenes", self.scenes != run.scenes().name()),
            ("trial", self.trial != run.trial),
            ("settings", self.settings != settings),
        ];
        match contradicts.into_iter().find(|(_, contradicts)| *contradicts) {
            Some((name, _)) => Err(format!("`{name}` contradicts the key `{}`", self.key)),
            None => Ok(()),
        }
    }
}

/// The result of a run, read from its line.
///
/// # Errors
/// If it is not the line of a run, or if two of its fields contradict each other.
pub fn read_line(line: &str) -> serde_json::Result<ReadLine> {
    let read: ReadLine = serde_json::from_str(line)?;
    let ReadLine { run, key, passed, violations, .. } = &read;
    if *run != run_name(key) {
        return Err(serde_json::Error::custom(format!("`run` is `{run}`, which is not that of the key `{key}`")));
    }
    if violations.as_ref().is_some_and(|violations| violations.is_empty() != *passed) {
        return Err(serde_json::Error::custom(format!("`passed` is {passed}, which contradicts `violations`")));
    }
    Ok(read)
}
