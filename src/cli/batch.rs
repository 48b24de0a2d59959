//! Many runs at once.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use indicatif::{ProgressBar, ProgressStyle};

use crate::report::{RunResult, picture};
use crate::scene::{Expectation, Violation};
use crate::score::Score;
use crate::study::{in_parallel, processors};

use super::exit::Failure;
use super::job::Job;

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
    let score = Score::new(&run, &job.scene.truth);
    let result = job.result(&run, &score);
    let violation = |expectation: &Expectation| expectation.violation(run.outcome, |metric| score.figure(metric));
    let violations: Vec<_> = job.scene.expect.iter().filter_map(violation).collect();
    let picture = is_drawn(&violations).then(|| picture(&job.scene, &result.policy, &run, &score));
    Ok(Finished { result, violations, picture })
}

/// Runs all jobs, on so many threads or on as many as there are processors, and gives what came of them in their order, with
/// pictures of those that are to be drawn, by what is not as expected. A bar on standard error shows how many are done, if that is a terminal.
pub(super) fn run_all(
    jobs: &[Job],
    threads: Option<NonZeroUsize>,
    is_drawn: impl Fn(&[Violation]) -> bool + Sync,
) -> Result<Vec<Finished>, Failure> {
    let bar = bar(jobs.len());
    let run = |job: &Job| finished(job, &is_drawn);
    let done = |finished: &Result<Finished, Failure>| {
        if let Ok(Finished { result, .. }) = finished {
            bar.set_message(format!("{}: {}", result.scenario, result.outcome));
        }
        bar.inc(1);
    };
    let finished = in_parallel(jobs, threads.unwrap_or_else(processors), run, done);
    bar.finish_and_clear();
    finished.into_iter().collect()
}

/// A bar on standard error, if that is a terminal, for so many runs.
pub(super) fn bar(runs: usize) -> ProgressBar {
    let bar = ProgressBar::new(runs as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos} of {len} runs {wide_bar} {elapsed}, {eta} left; {msg}") {
        bar.set_style(style);
    }
    bar
}
