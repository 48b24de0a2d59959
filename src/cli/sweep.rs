//! `vibrissa sweep`

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::file::CommandFiles;
use crate::study::stream_in_parallel;
use crate::sweep::Sweep;
use crate::sweep::{Answer, Results, StartError, SweepLine, SweepSummary, Worker, answer, read_line, summary_table};

use super::arguments::{Columns, SweepArguments};
use super::batch::threads;
use super::exit::{Exit, Failure};
use super::output;
use super::plan::Plan;
use super::progress::{Kept, Progress};
use super::run::make_directory;

pub(super) fn sweep(arguments: &SweepArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let plan = Plan::read(&arguments.file, !arguments.pruning.no_prune, &mut files)?;
    plan.tell_warnings(&mut files)?;
    plan.check()?;
    let sweep = &plan.sweep;
    let directory = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(sweep.name()));
    make_directory(Some(&directory))?;
    let path = directory.join(arguments.shard.file_name());
    files.growing("--out", &path)?;
    let header = plan.header(arguments.shard);
    let (mut results, mut done) = Results::open(&path, &header, sweep)?;
    let resumed = done.len();
    let runs = sweep.runs().filter(|run| arguments.shard.has(&run.key()));
    let left: Vec<u64> = runs.map(|run| run.index).filter(|index| !done.contains_key(index)).collect();
    let mut progress = Progress::resumed(resumed as u64, left.len() as u64, Kept::In(path.clone()));
    let fingerprint = header.fingerprint();
    let start = || worker(arguments, &fingerprint);
    let mut failure = None;
    stream_in_parallel(
        &left,
        threads(arguments.jobs),
        || None,
        |slot, index| answer(slot, start, &index.to_string()),
        |task, answer| {
            let index = left[task];
            let added = line(sweep, index, answer).and_then(|line| {
                let (key, figures) = read_line(&line).map_err(Failure::Answer)?;
                results.add(&line)?;
                done.insert(index, figures);
                progress.done(key);
                Ok(())
            });
            failure = added.err();
            if failure.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        },
    );
    progress.finish();
    if let Some(failure) = failure {
        return Err(failure);
    }
    let summary = SweepSummary::new(sweep, &done, resumed);
    tell(&summary, &path, arguments.json, arguments.columns)?;
    Ok(if summary.without_result() == 0 { Exit::Done } else { Exit::Unexpected })
}

/// A process for runs: this program once more, so that what ends it ends no other run.
fn worker(arguments: &SweepArguments, fingerprint: &str) -> Result<Worker, StartError> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("worker").arg(&arguments.file);
    if arguments.pruning.no_prune {
        command.arg("--no-prune");
    }
    Worker::start(&mut command, fingerprint)
}

/// The line of the run with this index.
fn line(sweep: &Sweep, index: u64, answer: Result<Answer, StartError>) -> Result<String, Failure> {
    Ok(match (answer?, sweep.run(index)) {
        (Answer::Crash(reason), Some(run)) => {
            output::message(format_args!("{}: crashed: {reason}", run.key()));
            output::json_line(&SweepLine::crashed(&run, reason))?
        }
        (Answer::Line(line) | Answer::Crash(line), _) => line,
    })
}

/// Prints what became of the runs whose results are at `path`.
pub(super) fn tell(summary: &SweepSummary, path: &Path, json: bool, columns: Columns) -> Result<(), Failure> {
    if json {
        return output::json(summary);
    }
    output::tables(&[summary_table(&summary.groups)], columns.wide)?;
    output::result(format_args!("results: {}", PathBuf::from(path).display()))
}
