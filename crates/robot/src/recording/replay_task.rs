//! The control task of a replay.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use rtrb::{Consumer, Producer, RingBuffer};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::signal::Sample;

use super::difference::{FieldDifference, first_difference};
use super::error::ReadError;
use super::setup::Setup;
use super::step_message::{RoundMessage, StepMessage};
use super::tick_message::TickMessage;
use crate::array::{Assembler, Round, StampedPose, period_ns};
use crate::drive::{ControlTask, Inputs, LoopRecord, Outputs, QUEUE, Records, TickReport, record_queues};
use crate::link::StampedCommand;
use crate::sensor::SensorModel;
use crate::vitals::Vitals;

/// Entries of the queues of a replay. A step takes at most what the queues of the loop hold, and what arrives meanwhile.
const REPLAY_QUEUE: usize = 4 * QUEUE;

/// The control task of a replay. It is the robot's own, and its inputs are recorded ones.
pub(super) struct ReplayTask {
    task: ControlTask,
    rounds: Vec<Producer<Round>>,
    poses: Producer<StampedPose>,
    commands: Consumer<StampedCommand>,
    records: Records,
    vitals: Arc<Vitals>,
    sensor: SensorModel,
    program: Arc<Program>,
    sample_period_ns: u64,
}

/// A replayed step.
pub(super) enum Stepped {
    /// The neutral values were still measured.
    Zeroing,
    /// The machine has been executed, or has waited.
    Tick(Box<TickReport>),
    /// The control task has ended with this message.
    Ended(String),
}

impl ReplayTask {
    /// The task at the start of a run.
    pub(super) fn new(setup: &Setup) -> Result<Self, ReadError> {
        let config = setup.config();
        let sensor = config.sensor()?;
        let control = Control::new(&config.rig, Arc::clone(setup.program()))?;
        let vitals = Arc::new(Vitals::default());
        let (mut rounds, mut taken) = (Vec::new(), Vec::new());
        for _ in &config.buses {
            let (producer, consumer) = RingBuffer::new(REPLAY_QUEUE);
            rounds.push(producer);
            taken.push(consumer);
        }
        let (poses, taken_poses) = RingBuffer::new(REPLAY_QUEUE);
        let (sent, commands) = RingBuffer::new(QUEUE);
        let ([sender, _], records) = record_queues();
        let inputs = Inputs { rounds: taken, poses: taken_poses };
        let outputs = Outputs { commands: sent, records: sender };
        let assembler = Assembler::new(config, &sensor);
        let task = ControlTask::new(config, control, assembler, inputs, outputs, Arc::clone(&vitals));
        let (program, sample_period_ns) = (Arc::clone(setup.program()), period_ns(config.rig.sensing.sample_rate));
        Ok(Self { task, rounds, poses, commands, records, vitals, sensor, program, sample_period_ns })
    }

    /// Repeats a step with its recorded inputs. The result is a difference if the driver decodes an input differently.
    pub(super) fn step(&mut self, step: &StepMessage) -> Result<Stepped, FieldDifference> {
        for (index, message) in step.rounds.iter().enumerate() {
            self.take_round(index, message)?;
        }
        for (index, message) in step.poses.iter().enumerate() {
            let is_taken = self.poses.push(message.into()).is_ok();
            is_taken.then_some(()).ok_or_else(|| no_room(format!("poses[{index}]")))?;
        }
        self.vitals.is_stopped.store(step.is_paused, Ordering::Release);
        let now = || step.started_ns;
        let task = &mut self.task;
        let time = step.time(self.sample_period_ns);
        let stepped = self.vitals.guard(|| task.step(time, now, |_, _, _| {}));
        while self.commands.pop().is_ok() {}
        let mut tick = None;
        while let Some(record) = self.records.next_record() {
            if let LoopRecord::Tick(report) = record {
                tick = Some(Box::new(report));
            }
        }
        Ok(match (stepped, tick) {
            (None, _) => Stepped::Ended("a panic".to_owned()),
            (Some(Err(fault)), _) => Stepped::Ended(fault.to_string()),
            (Some(Ok(_)), Some(report)) => Stepped::Tick(report),
            (Some(Ok(_)), None) => Stepped::Zeroing,
        })
    }

    /// The samples of the newest step, oldest first.
    pub(super) fn samples(&self) -> &[Sample] {
        self.task.samples()
    }

    fn take_round(&mut self, index: usize, message: &RoundMessage) -> Result<(), FieldDifference> {
        let round = message.decoded(&self.sensor).map_err(|found| FieldDifference {
            field: format!("rounds[{index}].boards[{}]", found.board),
            recorded: format!("{:?}", found.recorded),
            replayed: found.decoded.map_or_else(|| "no reading".to_owned(), |state| format!("{state:?}")),
        })?;
        let is_taken = self.rounds.get_mut(message.bus()).is_some_and(|queue| queue.push(round).is_ok());
        is_taken.then_some(()).ok_or_else(|| no_room(format!("rounds[{index}]")))
    }

    /// The first difference of a step from the recorded tick, if there is one.
    pub(super) fn difference(
        &self,
        stepped: &Stepped,
        recorded: Option<&TickMessage>,
    ) -> Result<Option<FieldDifference>, serde_json::Error> {
        let tick = |recorded: &str, replayed: &str| {
            let (recorded, replayed) = (recorded.to_owned(), replayed.to_owned());
            Ok(Some(FieldDifference { field: "tick".to_owned(), recorded, replayed }))
        };
        match (stepped, recorded) {
            (Stepped::Zeroing, None) => Ok(None),
            (Stepped::Zeroing, Some(_)) => tick("a tick", "no tick"),
            (Stepped::Tick(_), None) => tick("no tick", "a tick"),
            (Stepped::Ended(message), None) => tick("no tick", message),
            (Stepped::Ended(message), Some(_)) => tick("a tick", message),
            (Stepped::Tick(report), Some(recorded)) => {
                // The end of a step depends on the computer.
                let mut replayed = TickMessage::new(report, &self.program);
                replayed.ended_ns = recorded.ended_ns;
                first_difference(recorded, &replayed)
            }
        }
    }
}

/// An input that no robot of this configuration can have taken in one step.
fn no_room(field: String) -> FieldDifference {
    FieldDifference { field, recorded: "an input".to_owned(), replayed: "no such bus, or no room".to_owned() }
}
