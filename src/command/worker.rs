//! `vibrissa worker`: a process for runs of a sweep, or for stress tests.

use std::io::stdin;
use std::path::PathBuf;
use std::sync::mpsc::channel;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, PruneOption};
use super::output;
use super::sweep::Pictures;
use super::trials::finished;
use vibrissa_lab::load::LoadError;
use vibrissa_lab::results::Document;
use vibrissa_lab::study::stress::StressTask;
use vibrissa_lab::sweep::{Plan, Shard, SweepLine, SweepRun};
use vibrissa_lab::trial::{StartError, engine_version};
use vibrissa_text::diagnostic::{Colour, terminal};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::Violation;

/// The arguments of `vibrissa worker`.
#[derive(Debug, Args)]
pub(super) struct WorkerArguments {
    /// Sweep file; stress tests without one
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    #[command(flatten)]
    prune: PruneOption,
    #[command(flatten)]
    array: ArrayOptions,
    /// The folder of the pictures of runs
    #[arg(long, value_name = "DIR", requires = "pictures")]
    folder: Option<PathBuf>,
    /// The runs whose pictures are written
    #[arg(long, value_enum, default_value_t = Pictures::None, requires = "folder")]
    pictures: Pictures,
}

/// Prints the fingerprint of the sweep, and then the line of each run whose index is read. Without a sweep it prints
/// the version, and the line of each stress test.
pub(super) fn worker(arguments: &WorkerArguments) -> Result<Exit, Failure> {
    let Some(file) = &arguments.file else {
        let tasks = StressTask::all()?;
        return serve(&engine_version(), |index| {
            let task = usize::try_from(index).ok().and_then(|index| tasks.get(index));
            task.map(|task| serde_json::to_string(&task.run()))
        });
    };
    let mut files = CommandFiles::new();
    let mismatch = arguments.array.load(&mut files)?;
    let plan = Plan::read(file, !arguments.prune.no_prune, mismatch, &mut files)?;
    serve(&plan.header(Shard::WHOLE).fingerprint(), |index| {
        plan.sweep.run(index).map(|run| serde_json::to_string(&line(&plan, &run, arguments).versioned(None)))
    })
}

/// Prints a greeting and then a line for each index, until the input ends or the output is closed.
fn serve(greeting: &str, line: impl Fn(u64) -> Option<serde_json::Result<String>>) -> Result<Exit, Failure> {
    output::result(greeting)?;
    let (sender, requests) = channel();
    let listen = move || {
        for request in stdin().lines().map_while(Result::ok) {
            if sender.send(request).is_err() {
                break;
            }
        }
        // The other process is gone, possibly during a run. Nobody waits for its result.
        std::process::exit(0);
    };
    std::thread::Builder::new().spawn(listen).map_err(StartError::Process)?;
    for request in requests {
        let Some(line) = request.parse().ok().and_then(&line) else {
            return Ok(Exit::Unusable);
        };
        output::result(line?)?;
    }
    Ok(Exit::Done)
}

/// Runs a trial, and writes its picture if it is wanted.
fn line(plan: &Plan, run: &SweepRun<'_>, arguments: &WorkerArguments) -> SweepLine {
    let is_drawn = |violations: &[Violation]| match arguments.pictures {
        Pictures::None => false,
        Pictures::Failed => !violations.is_empty(),
        Pictures::All => true,
    };
    let finished = plan.trial(run).map_err(Failure::from).and_then(|trial| {
        let finished = finished(&trial, is_drawn)?;
        if let (Some(figures), Some(folder)) = (&finished.figures, &arguments.folder) {
            let path = folder.join(format!("{}.svg", run.hash()));
            let written = CommandFiles::new().output("--out", &path).and_then(|file| file.write(&figures.picture));
            // The result of a run does not depend on its picture.
            if let Err(error) = written {
                output::error(error);
            }
        }
        Ok((finished, trial))
    });
    match finished {
        Ok((finished, trial)) => SweepLine::ran(run, trial.scene.description, finished.result),
        Err(failure) => SweepLine::refused(run, reason(&failure)),
    }
}

fn reason(failure: &Failure) -> String {
    match failure {
        Failure::Load(LoadError::Faults { source_text, faults }) => terminal(source_text, faults, Colour::Plain),
        other => other.to_string(),
    }
}
