//! The runs of a list of trials.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::experiment::{Experiment, FinishedRun};
use super::failure::Failure;
use super::options::Jobs;
use super::output;
use super::provenance::provenance;
use super::report_folder::ReportFolder;
use super::trials::{Finished, calibrated, finished};
use vibrissa_lab::load::GivenMismatch;
use vibrissa_lab::results::{MismatchIdentity, ObjectFriction};
use vibrissa_lab::sweep::{Header, Results, ResultsError};
use vibrissa_lab::trial::{ExecuteError, Trial, check_world, engine_version, short_hash};
use vibrissa_world::scene::Violation;

/// A finished run in the file of a report's folder.
#[derive(Serialize, Deserialize)]
struct Line<F> {
    /// Its index among the trials.
    run: usize,
    /// Its friction, which its document does not have.
    friction: Option<ObjectFriction>,
    finished: F,
}

/// Calibrates the array of each trial and runs it, in parallel. Returns the results in order. A trial has figures if
/// `is_drawn` is true for its violations. Standard error shows the progress, and the calibrations of the runs.
///
/// The folder of a `report` has the finished runs until the report is there. The same command resumes from them.
///
/// A trial that cannot begin has a result that says so, unless no trial can.
pub(super) fn run_all(
    trials: &[Trial],
    array: &GivenMismatch,
    jobs: Jobs,
    report: Option<&ReportFolder>,
    is_drawn: impl Fn(&[Violation]) -> bool + Sync,
) -> Result<Vec<Finished>, Failure> {
    let mut done = BTreeMap::new();
    let results = report.map(|report| open(report, trials, array, &mut done)).transpose()?;
    let file = report.map(|report| report.unfinished().to_owned()).zip(results);
    let left: Vec<usize> = (0..trials.len()).filter(|index| !done.contains_key(index)).collect();
    let mut experiment = Experiment::new(trials.len(), done, file);
    let mut failures = BTreeMap::new();
    let run = |(): &mut (), &index: &usize| {
        let trial = trials.get(index)?;
        Some(calibrated(trial, array).and_then(|trial| finished(&trial, &is_drawn)))
    };
    experiment.run(
        &left,
        jobs,
        || (),
        run,
        |&key, result| match result {
            None => Ok(None),
            Some(Err(failure)) => {
                failures.insert(key, failure);
                Ok(None)
            }
            Some(Ok(result)) => {
                let (friction, finished) = (result.result.friction, &result);
                let line = serde_json::to_string(&Line { run: key, friction, finished })?;
                let shown = format!("{}: {}", result.result.scenario, result.result.outcome);
                Ok(Some(FinishedRun { key, result, line, shown }))
            }
        },
    )?;
    let mut finished = experiment.finish();
    let has_result = !finished.is_empty();
    for (index, failure) in failures {
        let Some(trial) = trials.get(index).filter(|_| has_result) else { return Err(failure) };
        finished.insert(index, refused(trial, failure)?);
    }
    output::calibrations(finished.values().filter_map(|finished| finished.result.calibration.as_ref()));
    Ok(finished.into_values().collect())
}

/// Opens the file of finished runs in the folder of a report, and reads those that are `done`.
fn open(
    report: &ReportFolder,
    trials: &[Trial],
    array: &GivenMismatch,
    done: &mut BTreeMap<usize, Finished>,
) -> Result<Results, ResultsError> {
    let header = header(report.command(), trials, array);
    Results::open(report.unfinished(), &header, &provenance(), |line| {
        // JSON has no number that is not finite. A run with one is repeated.
        let Ok(Line::<Finished> { run, friction, mut finished }) = serde_json::from_str(line) else { return Ok(()) };
        let trial = trials.get(run).ok_or_else(|| format!("there is no run {run}"))?;
        finished.result.friction = friction;
        // Its file does not say whether values are drawn from ranges.
        finished.result.mismatch = trial.scene.mismatch.as_ref().map(MismatchIdentity::from);
        let twice = done.insert(run, finished).is_some();
        if twice { Err(format!("the run {run} occurs a second time")) } else { Ok(()) }
    })
}

/// All that the results of trials depend on.
fn header(command: &str, trials: &[Trial], array: &GivenMismatch) -> Header {
    let all = trials.iter().fold(Sha256::new(), |hash, trial| hash.chain_update(format!("{:?}\n", trial.identity())));
    let inputs = [("the program", engine_version()), ("the runs", short_hash(&all.finalize()))];
    let inputs = inputs.into_iter().map(|(name, value)| (name.to_owned(), value));
    Header::new(command, inputs.chain(array.inputs()))
}

/// The result of a trial that cannot begin. Other failures concern all trials, such as a missing simulator.
fn refused(trial: &Trial, failure: Failure) -> Result<Finished, Failure> {
    let reason = match &failure {
        Failure::Execute { cause: ExecuteError::Interrupted, .. } => return Err(failure),
        Failure::Execute { cause, .. } if check_world(trial.world.kind).is_ok() => cause.to_string(),
        Failure::Calibration { cause, .. } if check_world(trial.world.kind).is_ok() => cause.to_string(),
        _ => return Err(failure),
    };
    Ok(Finished { result: trial.refused(reason), figures: None })
}
