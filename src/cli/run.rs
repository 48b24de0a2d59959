//! `vibrissa run`

use std::path::{Path, PathBuf};

use crate::file::CommandFiles;
use crate::report::{RunResult, results_table, tick_lines};
use crate::score::Score;

use super::arguments::{Columns, RunArguments};
use super::exit::{Exit, Failure};
use super::job::{Job, ReportFiles, Told, extended, tell};
use super::output;

pub(super) fn run(arguments: &RunArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let jobs = Job::all(arguments, &mut files, &mut Told::default())?;
    let reports = reports(&jobs, arguments.out.as_deref(), &mut files)?;
    let tick_file = arguments.ticks.as_ref().map(|path| files.output("--ticks", path)).transpose()?;
    let (mut results, mut exit, mut ticks) = (Vec::with_capacity(jobs.len()), Exit::Done, String::new());
    for (job, report) in jobs.iter().zip(reports) {
        let run = job.execute_with_bar()?;
        let (result, held) = finish(job, &run, report)?;
        if !held {
            exit = Exit::Unexpected;
        }
        if tick_file.is_some() {
            for line in tick_lines(&result.scenario, &run.trace) {
                ticks += &output::json_line(&line)?;
            }
        }
        results.push(result);
    }
    if let Some(file) = tick_file {
        file.write(ticks)?;
    }
    if arguments.json {
        output::json_list(&results)?;
    } else {
        show(&results, arguments.out.as_deref(), arguments.columns)?;
    }
    Ok(exit)
}

/// Makes the directory that reports go to.
pub(super) fn make_directory(directory: Option<&Path>) -> Result<(), Failure> {
    directory.map_or(Ok(()), |directory| std::fs::create_dir_all(directory).map_err(Failure::folder(directory)))
}

/// Makes the directory, and gives the places in it for the reports of jobs, if there is to be one.
pub(super) fn reports(
    jobs: &[Job],
    directory: Option<&Path>,
    files: &mut CommandFiles,
) -> Result<Vec<Option<ReportFiles>>, Failure> {
    make_directory(directory)?;
    let report = |job: &Job| {
        let report = directory.map(|directory| ReportFiles::new(&stem(directory, &job.scene.name), files));
        Ok(report.transpose()?)
    };
    jobs.iter().map(report).collect()
}

/// Scores a run, says which of the scenario's expectations do not hold, and writes the report; whether all held.
pub(super) fn finish(
    job: &Job,
    run: &crate::run::Run,
    report: Option<ReportFiles>,
) -> Result<(RunResult, bool), Failure> {
    let score = Score::new(run, &job.scene.truth, &job.scene.rig);
    let result = job.result(run, &score);
    tell(&result);
    let mut held = true;
    for expectation in &job.scene.expect {
        if let Some(violation) = expectation.violation(run.outcome, |metric| score.figure(metric)) {
            output::message(format_args!("{}: {violation}", job.scene.name));
            held = false;
        }
    }
    if let Some(report) = report {
        job.write_report(report, run, &score, &result)?;
    }
    Ok((result, held))
}

/// Prints the results as a table, and where the reports are.
pub(super) fn show(results: &[RunResult], directory: Option<&Path>, columns: Columns) -> Result<(), Failure> {
    output::tables(&[results_table(results)], columns.wide)?;
    for result in results {
        if let Some(directory) = directory {
            output::result(format_args!("report: {}", extended(&stem(directory, &result.scenario), "svg").display()))?;
        }
    }
    Ok(())
}

fn stem(directory: &Path, scenario: &str) -> PathBuf {
    directory.join(scenario)
}
