//! `vibrissa stress`

use std::ops::ControlFlow;
use std::process::Command;

use crate::scene::WorldKind;
use crate::study::stress::{StressRow, StressTask, stress_tables};
use crate::study::{check_world, engine_version, stream_in_parallel};
use crate::sweep::{Answer, StartError, Worker, answer};

use super::arguments::StressArguments;
use super::batch::threads;
use super::exit::{Exit, Failure};
use super::output;
use super::progress::Progress;

pub(super) fn stress(arguments: &StressArguments) -> Result<Exit, Failure> {
    // A build without MuJoCo's world has no hard cases of it; where only the library is missing, they could not but fail.
    if cfg!(feature = "sim") {
        check_world(WorldKind::Mujoco).map_err(Failure::World)?;
    }
    let tasks = StressTask::all()?;
    let indices: Vec<usize> = (0..tasks.len()).collect();
    let mut progress = Progress::new(tasks.len());
    let mut rows: Vec<(usize, StressRow)> = Vec::with_capacity(tasks.len());
    let mut failure = None;
    stream_in_parallel(
        &indices,
        threads(arguments.jobs),
        || None,
        |slot, index| answer(slot, worker, &index.to_string()),
        |index, answer| {
            match row(&tasks[index], answer) {
                Ok(row) => rows.push((index, row)),
                Err(cause) => failure = Some(cause),
            }
            progress.done(tasks[index].name());
            if failure.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        },
    );
    progress.finish();
    if let Some(failure) = failure {
        return Err(failure);
    }
    rows.sort_by_key(|(index, _)| *index);
    let rows: Vec<StressRow> = rows.into_iter().map(|(_, row)| row).collect();
    if arguments.json {
        output::json_list(&rows)?;
    } else {
        output::tables(&stress_tables(&rows), arguments.columns.wide)?;
    }
    Ok(if rows.iter().all(StressRow::is_sound) { Exit::Done } else { Exit::Unexpected })
}

/// A process for cases, so that one that ends it costs no other.
fn worker() -> Result<Worker, StartError> {
    Worker::start(Command::new(std::env::current_exe()?).arg("worker"), &engine_version())
}

fn row(task: &StressTask, answer: Result<Answer, StartError>) -> Result<StressRow, Failure> {
    match answer? {
        Answer::Line(line) => serde_json::from_str(&line).map_err(Failure::Answer),
        Answer::Crash(reason) => Ok(task.crashed(reason)),
    }
}
