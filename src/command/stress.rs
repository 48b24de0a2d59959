//! `vibrissa study stress`

use std::process::Command;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{Format, Jobs};
use super::output;
use super::progress::Progress;
use super::provenance::{provenance, simulator};
use vibrissa_lab::report::stress_tables;
use vibrissa_lab::study::stress::{StressRow, StressTask};
use vibrissa_lab::trial::{Answer, StartError, Worker, answer, check_world, engine_version, stream_in_parallel};
use vibrissa_world::scene::WorldKind;

const EXAMPLE: &str = "Example:\n  vibrissa study stress --jobs 2\n\nExit status: 0 every case had a regular outcome and finite numbers; 1 otherwise; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study stress`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct StressArguments {
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

pub(super) fn stress(arguments: &StressArguments) -> Result<Exit, Failure> {
    // A build without MuJoCo has no stress tests of it. If only its library is missing, they could only fail.
    if cfg!(feature = "sim") {
        check_world(WorldKind::Mujoco).map_err(Failure::World)?;
    }
    let tasks = StressTask::all()?;
    let indices: Vec<usize> = (0..tasks.len()).collect();
    let mut progress = Progress::new(tasks.len());
    let mut rows: Vec<(usize, StressRow)> = Vec::with_capacity(tasks.len());
    stream_in_parallel(
        &indices,
        arguments.jobs.threads(),
        || None,
        |slot, index| answer(slot, worker, &index.to_string()),
        |index, answer| {
            rows.push((index, row(&tasks[index], answer)?));
            progress.done(tasks[index].name());
            Ok::<(), Failure>(())
        },
    )?;
    progress.finish();
    rows.sort_by_key(|(index, _)| *index);
    let rows: Vec<StressRow> = rows.into_iter().map(|(_, row)| row).collect();
    let mut provenance = provenance();
    for row in &rows {
        let (StressRow::Case { name, world, .. } | StressRow::Step { name, world, .. }) = row;
        provenance.add_scene(name);
        provenance.add_simulator(simulator(world));
    }
    output::documents(arguments.format, &provenance, &rows, || stress_tables(&rows))?;
    Ok(if rows.iter().all(StressRow::is_sound) { Exit::Done } else { Exit::Unexpected })
}

/// A process for stress tests. A crash ends only one of them.
fn worker() -> Result<Worker, StartError> {
    Worker::start(Command::new(std::env::current_exe()?).arg("worker"), &engine_version())
}

fn row(task: &StressTask, answer: Result<Answer, StartError>) -> Result<StressRow, Failure> {
    match answer? {
        Answer::Line(line) => serde_json::from_str(&line).map_err(Failure::Answer),
        Answer::Crash(reason) => Ok(task.crashed(reason)),
    }
}
