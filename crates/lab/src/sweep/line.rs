//! The result of a run of a sweep, as a line.

use crate::results::Document;
use std::collections::BTreeMap;

use serde::de::Error as _;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::results::{CalibrationIdentity, Ending, Figures, RunResult, figure_in};
use crate::sweep::SweepRun;

use super::shard::run_name;

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

/// The fields of a line that are counted.
#[derive(Debug, Deserialize)]
struct Counted {
    run: String,
    key: String,
    passed: bool,
    #[serde(default)]
    passed_but_for_tips: bool,
    outcome: Ending,
    #[serde(flatten)]
    figures: Value,
}

/// The key and the figures of a run, read from its line.
///
/// # Errors
/// If it is not the line of a run, or if its two names of the run do not belong together.
pub fn read_line(line: &str) -> serde_json::Result<(String, Figures)> {
    let Counted { run, key, passed, passed_but_for_tips, outcome, figures } = serde_json::from_str(line)?;
    if run != run_name(&key) {
        return Err(serde_json::Error::custom(format!("`run` is `{run}`, which is not that of the key `{key}`")));
    }
    let of_run = Figures::of(outcome, |metric| figure_in(&figures, metric));
    Ok((key, Figures { passed, passed_but_for_tips, ..of_run }))
}

/// The calibration of a run, read from its line.
#[must_use]
pub fn read_calibration(line: &str) -> Option<CalibrationIdentity> {
    #[derive(Deserialize)]
    struct Calibrated {
        calibration: Option<CalibrationIdentity>,
    }
    serde_json::from_str::<Calibrated>(line).ok()?.calibration
}
