//! `vibrissa run`

use std::path::{Path, PathBuf};

use crate::report::{RunResult, table, tick_lines};
use crate::score::Score;

use super::arguments::RunArguments;
use super::exit::{Exit, Failure};
use super::job::{Files, Job, extended, tell};
use super::{file, output};

pub(super) fn run(arguments: &RunArguments) -> Result<Exit, Failure> {
    let jobs = Job::all(arguments, &mut Files::default())?;
    make_directory(arguments.out.as_deref())?;
    let (mut results, mut exit, mut ticks) = (Vec::with_capacity(jobs.len()), Exit::Done, String::new());
    for job in &jobs {
        let run = job.execute_with_bar()?;
        let (result, held) = finish(job, &run, arguments.out.as_deref())?;
        if !held {
            exit = Exit::Unexpected;
        }
        if arguments.ticks.is_some() {
            for line in tick_lines(&result.scenario, &run.trace) {
                ticks.push_str(&serde_json::to_string(&line)?);
                ticks.push('\n');
            }
        }
        results.push(result);
    }
    if let Some(path) = &arguments.ticks {
        file::write(path, ticks)?;
    }
    if arguments.json {
        output::json(&results)?;
    } else {
        show(&results, arguments.out.as_deref())?;
    }
    Ok(exit)
}

/// Makes the directory that reports go to.
pub(super) fn make_directory(directory: Option<&Path>) -> Result<(), Failure> {
    directory.map_or(Ok(()), |directory| std::fs::create_dir_all(directory).map_err(Failure::write(directory)))
}

/// Scores a run, says which of the scenario's expectations do not hold, and writes the report; whether all held.
pub(super) fn finish(job: &Job, run: &crate::run::Run, directory: Option<&Path>) -> Result<(RunResult, bool), Failure> {
    let score = Score::new(run, &job.scene.truth);
    let result = job.result(run, &score);
    tell(&result);
    let mut held = true;
    for expectation in &job.scene.expect {
        if let Some(violation) = expectation.violation(run.outcome, |metric| score.figure(metric)) {
            output::message(format_args!("{}: {violation}", job.scene.name));
            held = false;
        }
    }
    if let Some(directory) = directory {
        job.write_report(&stem(directory, &result), run, &score, &result)?;
    }
    Ok((result, held))
}

/// Prints the results as a table, and where the reports are.
pub(super) fn show(results: &[RunResult], directory: Option<&Path>) -> Result<(), Failure> {
    output::result(table(results))?;
    for result in results {
        if let Some(directory) = directory {
            output::result(format_args!("report: {}", extended(&stem(directory, result), "svg").display()))?;
        }
    }
    Ok(())
}

fn stem(directory: &Path, result: &RunResult) -> PathBuf {
    directory.join(&result.scenario)
}
