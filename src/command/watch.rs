//! `vibrissa run --watch`

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher};

#[cfg(feature = "live")]
use crate::live::RunSetup;
use vibrissa_lab::results::Provenance;
use vibrissa_lab::run::{TickRecord, Trace, Watcher as RunWatcher};
use vibrissa_lab::score::Statistics;
use vibrissa_lab::trial::{ExecuteError, Trial, TrialResult};
use vibrissa_text::file::CommandFiles;

use super::exit::Exit;
use super::failure::Failure;
#[cfg(feature = "live")]
use super::live::{REAL_TIME, begin};
use super::output;
use super::provenance::of_trials;
use super::reports::Reports;
use super::run::{self, Prepared, RunArguments};
use super::trials::{make_directory, run_each_second, seconds};
use vibrissa_lab::load::LoadError;

/// Editors write a file in several steps. They are done if nothing has happened for this time.
const QUIET: Duration = Duration::from_millis(15);

/// Runs again whenever an input file changes. It ends only with the program.
pub(super) fn watch(arguments: &RunArguments) -> Result<Exit, Failure> {
    let mut watch = Watch::new()?;
    // A missing file can be created later.
    let first = arguments.scenarios.iter().chain(&arguments.policy);
    watch.add(first.cloned().collect())?;
    make_directory(arguments.out.as_deref())?;
    #[cfg(feature = "live")]
    let live = arguments.live.start(REAL_TIME, &arguments.inspection.breakpoints)?;
    loop {
        let mut files = CommandFiles::new();
        let trials = run::prepared_trials(arguments, &mut files);
        if watch.add(files.inputs().map(Path::to_owned).collect())? {
            // Files that were written to a new folder before it was watched have been missed.
            continue;
        }
        let run = |trial: &Prepared| {
            #[cfg(feature = "live")]
            let page =
                |live| begin(live, RunSetup::simulated(&trial.trial, trial.text.clone()), || watch.has_changed());
            #[cfg(feature = "live")]
            let mut page = live.as_ref().map(page).transpose()?;
            #[cfg(not(feature = "live"))]
            let mut page = ();
            let finished = run_printed(&trial.trial, &mut page, &watch)?;
            #[cfg(feature = "live")]
            if let Some(page) = page {
                page.finish(&finished);
            }
            Ok(finished)
        };
        match trials.and_then(|trials| run_all(&trials, arguments, &mut files, run)) {
            Err(Failure::Execute { cause: ExecuteError::Interrupted, .. }) => continue,
            Err(failure) => failure.report(),
            Ok((provenance, reports)) => reports.show(&provenance, arguments.format)?,
        }
        output::message(format_args!("watching {} files; Ctrl-C ends", watch.files.len()));
        watch.wait();
    }
}

fn run_all(
    trials: &[Prepared],
    arguments: &RunArguments,
    files: &mut CommandFiles,
    run: impl Fn(&Prepared) -> Result<TrialResult, Failure>,
) -> Result<(Provenance, Reports), Failure> {
    let provenance = of_trials(trials.iter().map(|prepared| &prepared.trial));
    let mut reports = Reports::new(trials.iter().map(|prepared| &prepared.trial), arguments.out.as_deref(), files)?;
    for (index, prepared) in trials.iter().enumerate() {
        let finished = run(prepared)?;
        reports.add(&provenance, index, &prepared.trial, &finished)?;
    }
    Ok((provenance, reports))
}

/// Runs a trial and prints a line for every simulated second. A change of a file interrupts it.
fn run_printed(trial: &Trial, watcher: &mut impl RunWatcher, watch: &Watch) -> Result<TrialResult, Failure> {
    let mut printed = Ok(());
    let finished = run_each_second(trial, watcher, |trace| {
        printed = print_second(trial, trace);
        if printed.is_err() || watch.has_changed() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    printed?;
    finished
}

/// Prints the state of a run at this second, and the error of the tips since the last line.
fn print_second(trial: &Trial, trace: &Trace) -> Result<(), Failure> {
    let state = trace.ticks.last().and_then(|tick| trace.states.get(tick.state?)).map_or("Failure", String::as_str);
    let now = seconds(trace);
    let recent = trace.ticks.iter().rev().take_while(|tick| tick.time > now - 1.0);
    let surfaces = &trial.scene.truth.surfaces;
    let errors = recent.flat_map(TickRecord::tips).map(|tip| surfaces.distance(tip));
    let error = Statistics::of(errors.collect()).map_or("no tips".to_owned(), |error| {
        format!("error {:.2} mm, at most {:.2} mm", error.mean() * 1e3, error.max() * 1e3)
    });
    output::result(format_args!("{} {now:>5.0} s  {state}  {error}", trial.scene.name))
}

/// Watches files for changes.
struct Watch {
    watcher: RecommendedWatcher,
    events: Receiver<notify::Result<Event>>,
    files: BTreeSet<PathBuf>,
    folders: BTreeSet<PathBuf>,
}

impl Watch {
    fn new() -> Result<Self, Failure> {
        let (sender, events) = channel();
        // The watcher does not report that its thread cannot be started, and then panics at the next request.
        let thread = std::thread::Builder::new().spawn(|| ()).map_err(Failure::NoWatch)?;
        let _ = thread.join();
        // Without a receiver the program is about to end.
        let watcher = notify::recommended_watcher(move |event| drop(sender.send(event)))?;
        Ok(Self { watcher, events, files: BTreeSet::new(), folders: BTreeSet::new() })
    }

    /// Watches more files. Returns true if one of their folders is new. Folders are watched, because editors replace
    /// files.
    fn add(&mut self, files: BTreeSet<PathBuf>) -> Result<bool, Failure> {
        let mut is_new = false;
        for file in files {
            // Events name files by absolute paths.
            let file = std::path::absolute(&file).map_err(LoadError::read(&file))?;
            let Some(folder) = file.parent().map(Path::to_owned) else { continue };
            self.files.insert(file);
            if !self.folders.contains(&folder) {
                self.watcher.watch(&folder, RecursiveMode::NonRecursive)?;
                self.folders.insert(folder);
                is_new = true;
            }
        }
        Ok(is_new)
    }

    /// True if a file has changed since the last call.
    fn has_changed(&self) -> bool {
        let changed = self.events.try_iter().any(|event| self.concerns(&event));
        if changed {
            self.settle();
        }
        changed
    }

    /// Waits until a file changes.
    fn wait(&self) {
        while let Ok(event) = self.events.recv() {
            if self.concerns(&event) {
                return self.settle();
            }
        }
    }

    /// Waits until the files no longer change.
    fn settle(&self) {
        let mut until = Instant::now() + QUIET;
        while let Ok(event) = self.events.recv_timeout(until.saturating_duration_since(Instant::now())) {
            if self.concerns(&event) {
                until = Instant::now() + QUIET;
            }
        }
    }

    /// True if an event concerns one of the files, or if events were lost.
    fn concerns(&self, event: &notify::Result<Event>) -> bool {
        let Ok(event) = event else { return true };
        event.need_rescan() || (!event.kind.is_access() && event.paths.iter().any(|path| self.files.contains(path)))
    }
}
