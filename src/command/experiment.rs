//! Many runs whose results are kept as soon as they are there. The same command resumes an interrupted one from them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::failure::Failure;
use super::options::Jobs;
use super::progress::{Kept, Progress};
use vibrissa_lab::sweep::Results;
use vibrissa_lab::trial::stream_in_parallel;

/// The runs of a command, with the file of their results if they are kept.
pub(super) struct Experiment<K, R> {
    results: Option<Results>,
    /// The results by the keys of their runs.
    pub(super) done: BTreeMap<K, R>,
    /// Number of results of earlier processes.
    pub(super) resumed: usize,
    progress: Progress,
}

/// A finished run.
pub(super) struct FinishedRun<K, R> {
    /// Its key.
    pub(super) key: K,
    /// Its result.
    pub(super) result: R,
    /// The line of the result in the file.
    pub(super) line: String,
    /// What the progress shows of it.
    pub(super) shown: String,
}

impl<K: Ord, R> Experiment<K, R> {
    /// So many `runs`. Those that are `done` have their results in the `file`.
    pub(super) fn new(runs: usize, done: BTreeMap<K, R>, file: Option<(PathBuf, Results)>) -> Self {
        let (resumed, left) = (done.len(), runs.saturating_sub(done.len()));
        let (path, results) = file.unzip();
        let progress = Progress::resumed(resumed as u64, left as u64, path.map_or(Kept::Nothing, Kept::In));
        Self { results, done, resumed, progress }
    }

    /// Executes tasks in parallel. Each thread has its own `tool`. `finished` receives the result of each task in the order of
    /// their ends. Without a finished run from it, nothing is kept of the task. Its first error ends the work.
    pub(super) fn run<T: Sync, S, W: Send>(
        &mut self,
        tasks: &[T],
        jobs: Jobs,
        tool: impl Fn() -> S + Sync,
        work: impl Fn(&mut S, &T) -> W + Sync,
        mut finished: impl FnMut(&T, W) -> Result<Option<FinishedRun<K, R>>, Failure>,
    ) -> Result<(), Failure> {
        let Self { results, done, progress, .. } = self;
        stream_in_parallel(tasks, jobs.threads(), tool, work, |index, result| {
            let Some(task) = tasks.get(index) else { return Ok(()) };
            let Some(FinishedRun { key, result, line, shown }) = finished(task, result)? else { return Ok(()) };
            results.as_mut().map_or(Ok(()), |results| results.add(&line))?;
            done.insert(key, result);
            progress.done(shown);
            Ok(())
        })
    }

    /// Ends the progress, and returns the results.
    pub(super) fn finish(self) -> BTreeMap<K, R> {
        self.progress.finish();
        self.done
    }
}
