//! The watcher of a run that records it.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use vibrissa_text::system::in_words;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Artifact, Observer};
use vibrissa_runtime::signal::Sample;

use super::error::RecordError;
use super::frame::RecordedFrame;
use super::setup::Setup;
use super::writer::Writer;
use crate::inspect::{Breakpoints, ExplainedControl};
use crate::run::{Run, Trace, Watcher};
use crate::trial::Trial;
use vibrissa_text::diagnostic::Source;
use vibrissa_world::geometry::ContourSet;

/// The number of ticks that the run passes on at once. A thread that waits for every tick would cost the run more.
const BATCH: usize = 64;
/// The number of batches that may wait. A run that is faster than its recording waits for it.
const QUEUE: usize = 16;

/// Records a run. A thread of its own encodes the recording.
#[derive(Debug)]
pub struct Recorder {
    samples: Vec<Sample>,
    batch: Vec<RecordedFrame>,
    thread: Option<WriterThread>,
    /// What the thread needs before the first tick.
    setup: Option<Box<(Setup, Option<ContourSet>)>>,
    /// The error at the first tick.
    failure: Option<RecordError>,
}

#[derive(Debug)]
struct WriterThread {
    sender: SyncSender<Vec<RecordedFrame>>,
    handle: JoinHandle<Result<Writer, RecordError>>,
}

impl Recorder {
    /// A recorder of a trial with the machine `artifact`. `policy` is the text of that machine, if there is one.
    ///
    /// # Errors
    /// [`RecordError`] if a value cannot be encoded.
    pub fn new(trial: &Trial, artifact: &Artifact, policy: Option<Source>) -> Result<Self, RecordError> {
        let setup = Setup::of_trial(trial, artifact, policy)?;
        Ok(Self::with_setup(setup, Some(trial.scene.truth.surfaces.clone())))
    }

    /// A recorder of a run with this setup. `surfaces` are the outlines of the objects, if they are known.
    pub(super) fn with_setup(setup: Setup, surfaces: Option<ContourSet>) -> Self {
        Self {
            samples: Vec::new(),
            batch: Vec::new(),
            thread: None,
            setup: Some(Box::new((setup, surfaces))),
            failure: None,
        }
    }

    /// The content of the file, after the run has ended. `outcome` says how.
    ///
    /// # Errors
    /// [`RecordError`] if the run had no tick, or if the recording cannot be encoded.
    pub fn finish(mut self, outcome: String, run: &Run) -> Result<Vec<u8>, RecordError> {
        self.send();
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let WriterThread { sender, handle } = self.thread.ok_or(RecordError::NoTick)?;
        drop(sender);
        let writer = handle.join().map_err(|_| RecordError::Thread("it panicked".to_owned()))??;
        let mut ending =
            BTreeMap::from([("outcome".to_owned(), outcome), ("final_state".to_owned(), run.final_state.clone())]);
        ending.extend(run.reason.clone().map(|reason| ("reason".to_owned(), reason)));
        writer.finish(ending)
    }

    /// Passes the collected ticks on.
    fn send(&mut self) {
        if let Some(thread) = &self.thread {
            // After an error of the thread, `finish` reports it.
            let _ = thread.sender.send(std::mem::take(&mut self.batch));
        }
    }

    /// Starts the thread with the names in the trace.
    fn start(&mut self, trace: &Trace) {
        let Some(setup) = self.setup.take() else { return };
        let mut empty = trace.clone();
        empty.ticks.clear();
        for plot in &mut empty.plots {
            plot.values.clear();
        }
        let (sender, receiver) = sync_channel(QUEUE);
        let thread = std::thread::Builder::new().name("recording".to_owned());
        match thread.spawn(move || write(&setup.0, setup.1.as_ref(), empty, &receiver)) {
            Ok(handle) => self.thread = Some(WriterThread { sender, handle }),
            Err(error) => self.failure = Some(RecordError::Thread(in_words(&error))),
        }
    }
}

impl Observer for Recorder {}

impl Watcher for Recorder {
    fn before_tick(&mut self, samples: &[Sample]) {
        self.samples.clear();
        self.samples.extend_from_slice(samples);
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        self.start(trace);
        self.batch.extend(RecordedFrame::last(trace, std::mem::take(&mut self.samples)));
        if self.batch.len() >= BATCH {
            self.send();
        }
        ControlFlow::Continue(())
    }
}

/// Writes all ticks that are received.
fn write(
    setup: &Setup,
    surfaces: Option<&ContourSet>,
    trace: Trace,
    receiver: &Receiver<Vec<RecordedFrame>>,
) -> Result<Writer, RecordError> {
    let mut writer = Writer::new(setup, surfaces, trace)?;
    let policy = setup.policy.as_ref().map(|source| Breakpoints::new(source, &[]).map_err(|_| RecordError::Explain));
    let policy = policy.transpose()?;
    let mut explained = policy.as_ref().map(|policy| explained(setup, policy)).transpose()?;
    for frame in receiver.iter().flatten() {
        writer.frame(frame, explained.as_mut())?;
    }
    Ok(writer)
}

/// A control loop that explains the guards, with the parameters of the run.
fn explained<'b>(setup: &Setup, policy: &'b Breakpoints) -> Result<ExplainedControl<'b>, RecordError> {
    let artifact = Artifact::from_bytes(&setup.machine)?;
    let program = policy.explained.with_parameters_of(&artifact.program);
    let control = Control::simulated(&setup.rig, Arc::new(program))?;
    let scenario = setup.identity.get("scenario").map_or("", String::as_str);
    Ok(ExplainedControl::new(control, policy, scenario))
}
