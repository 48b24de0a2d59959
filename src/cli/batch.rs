//! Many runs at once.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Once;

use crate::report::{RunResult, picture};
use crate::scene::{Expectation, Violation};
use crate::score::Score;
use crate::study::{Threads, in_parallel, processors};

use super::exit::Failure;
use super::job::Job;
use super::output;
use super::progress::Progress;

/// As many threads as are asked for, or as there are processors.
pub(super) fn threads(jobs: Option<NonZeroUsize>) -> Threads {
    static TOLD: Once = Once::new();
    let fewer = |started| {
        TOLD.call_once(|| output::message(format_args!("warning: the system starts no more than {started} at a time")));
    };
    Threads { count: jobs.unwrap_or_else(processors), fewer }
}

/// What is kept of a run: its trace is large.
pub(super) struct Finished {
    pub(super) result: RunResult,
    /// What is not as the scenario expects.
    pub(super) violations: Vec<Violation>,
    /// Its picture, if one was asked for.
    pub(super) picture: Option<String>,
}

/// Runs one job. It is drawn if `is_drawn` says so of what is not as expected.
pub(super) fn finished(job: &Job, is_drawn: impl Fn(&[Violation]) -> bool) -> Result<Finished, Failure> {
    let run = job.execute(|_| ControlFlow::Continue(()))?;
    let score = Score::new(&run, &job.scene.truth, &job.scene.rig);
    let result = job.result(&run, &score);
    let violation = |expectation: &Expectation| expectation.violation(run.outcome, |metric| score.figure(metric));
    let violations: Vec<_> = job.scene.expect.iter().filter_map(violation).collect();
    let picture = is_drawn(&violations).then(|| picture(&job.scene, &result.policy, &run, &score));
    Ok(Finished { result, violations, picture })
}

/// Runs all jobs, on so many threads or on as many as there are processors, and gives what came of them in their order, with
/// pictures of those that are to be drawn, by what is not as expected. Standard error tells how many are done.
pub(super) fn run_all(
    jobs: &[Job],
    asked: Option<NonZeroUsize>,
    is_drawn: impl Fn(&[Violation]) -> bool + Sync,
) -> Result<Vec<Finished>, Failure> {
    let mut progress = Progress::new(jobs.len());
    let run = |job: &Job| finished(job, &is_drawn);
    let done = |finished: &Result<Finished, Failure>| {
        if let Ok(Finished { result, .. }) = finished {
            progress.done(format_args!("{}: {}", result.scenario, result.outcome));
        }
    };
    let finished = in_parallel(jobs, threads(asked), run, done);
    progress.finish();
    finished.into_iter().collect()
}
