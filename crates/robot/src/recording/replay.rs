//! Replay: the recorded inputs through the driver's decoding, perception and the machine again.

use std::io::Read;

use super::channel::{Channel, Message};
use super::difference::{Difference, FieldDifference};
use super::error::ReadError;
use super::recording::Recording;
use super::replay_task::{ReplayTask, Stepped};
use super::step_message::StepMessage;
use super::tick_message::{EventMessage, TickMessage};
use crate::fault::FaultEvent;
use vibrissa_runtime::signal::Sample;

/// The result of a replay.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Replayed {
    /// Number of steps.
    pub steps: u64,
    /// Number of steps whose results were compared.
    pub ticks: u64,
    /// Start of the last step since the start of the program (ns).
    pub end_ns: u64,
    /// Changes of faults, in the order of the recording.
    pub events: Vec<FaultEvent>,
    /// The first difference. The replay ends there.
    pub difference: Option<Difference>,
    /// True if the end of the recording is missing.
    pub is_cut: bool,
}

/// Replays a recording and compares every result, bit for bit.
///
/// # Errors
/// [`ReadError`] if the recording cannot be read, or if it does not have every input from the start of the run.
pub fn replay<R: Read>(recording: Recording<R>) -> Result<Replayed, ReadError> {
    replay_observed(recording, |_| {})
}

/// Replays a recording as [`replay`] does. `observe` receives the samples of each tick in which the machine ran, oldest first.
///
/// # Errors
/// Those of [`replay`].
pub fn replay_observed<R: Read>(
    mut recording: Recording<R>,
    mut observe: impl FnMut(&[Sample]),
) -> Result<Replayed, ReadError> {
    let task = ReplayTask::new(recording.setup())?;
    let mut replay = Replay { task, last: None, result: Replayed::default() };
    while let Some(message) = recording.next_message()? {
        let found = match message.channel {
            Channel::Steps => {
                let found = replay.step(&message)?;
                if let Some(Stepped::Tick(report)) = &replay.last
                    && !report.is_paused
                {
                    observe(replay.task.samples());
                }
                found
            }
            Channel::Ticks => replay.tick(&message)?,
            Channel::Events => {
                let event: EventMessage = read(&message)?;
                replay.result.events.push(event.into());
                None
            }
            Channel::Packets => None,
        };
        if let Some(FieldDifference { field, recorded, replayed }) = found {
            let (step, time_ns) = (replay.result.steps.saturating_sub(1), replay.result.end_ns);
            replay.result.difference = Some(Difference { step, time_ns, field, recorded, replayed });
            return Ok(replay.result);
        }
    }
    replay.result.is_cut = recording.is_cut();
    Ok(replay.result)
}

/// A replay and its result until now.
struct Replay {
    task: ReplayTask,
    /// The last step, until its recorded tick has come.
    last: Option<Stepped>,
    result: Replayed,
}

impl Replay {
    fn step(&mut self, message: &Message) -> Result<Option<FieldDifference>, ReadError> {
        let step: StepMessage = read(message)?;
        if step.lost > 0 {
            return Err(ReadError::Lost { time_s: message.time_ns as f64 * 1e-9, count: step.lost });
        }
        // The last step has no recorded tick if the next one follows it.
        if let Some(last) = self.last.take()
            && let Some(difference) = self.task.difference(&last, None)?
        {
            return Ok(Some(difference));
        }
        self.result.steps += 1;
        self.result.end_ns = step.started_ns;
        match self.task.step(&step) {
            Ok(stepped) => {
                self.last = Some(stepped);
                Ok(None)
            }
            Err(difference) => Ok(Some(difference)),
        }
    }

    fn tick(&mut self, message: &Message) -> Result<Option<FieldDifference>, ReadError> {
        let recorded: TickMessage = read(message)?;
        let last = self.last.take().ok_or_else(|| ReadError::Damaged("a tick has no step before it".to_owned()))?;
        self.result.ticks += 1;
        Ok(self.task.difference(&last, Some(&recorded))?)
    }
}

fn read<'m, M: serde::Deserialize<'m>>(message: &'m Message) -> Result<M, ReadError> {
    serde_json::from_slice(&message.data).map_err(|error| {
        let (sequence, topic) = (message.sequence, message.channel.topic());
        ReadError::Damaged(format!("message {sequence} of the channel `{topic}` is not valid: {error}"))
    })
}
