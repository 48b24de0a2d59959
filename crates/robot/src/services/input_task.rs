//! The task of the sensor IO that publishes the inputs of the control task.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use rtrb::{Consumer, Producer, RingBuffer};

use super::inputs::{Inputs, Session};
use crate::array::{Round, StampedPose};
use crate::config::{Config, MqttConfig};
use crate::drive::{LoopRecord, RecordSender, StepInput, StepTime};
use crate::link::MqttLink;
use crate::mqtt::{Message, StartError};
use crate::telemetry::{Source, Topic};
use crate::vitals::Vitals;

/// Messages that wait for the thread of the link.
const WAITING: usize = 4;
/// Bytes that the system keeps: some messages.
const BYTES: u32 = 32_768;

/// Publishes the inputs of the control task, once per control period. A message that cannot be sent at once is dropped,
/// because old inputs are worthless to the controller.
#[derive(Debug)]
pub struct InputTask {
    session: Session,
    topic: Arc<str>,
    rounds: Vec<Consumer<Round>>,
    poses: Consumer<StampedPose>,
    records: RecordSender,
    messages: Producer<Message>,
    link: MqttLink,
    vitals: Arc<Vitals>,
}

impl InputTask {
    /// The task of a robot. It takes these rounds of each bus, and these poses.
    ///
    /// # Errors
    /// [`StartError`] if the connection cannot begin.
    pub fn new(
        config: &Config,
        broker: &MqttConfig,
        rounds: Vec<Consumer<Round>>,
        poses: Consumer<StampedPose>,
        records: RecordSender,
        vitals: Arc<Vitals>,
    ) -> Result<Self, StartError> {
        let name = Source::SensorIo.name(&config.name);
        let (messages, mut waiting) = RingBuffer::new(WAITING);
        let link = MqttLink::start(&name, "inputs", broker, BYTES, None, move || waiting.pop().ok(), |_| {})?;
        let topic = Topic::Inputs.of(&name).into();
        Ok(Self { session: Session::start(config), topic, rounds, poses, records, messages, link, vitals })
    }

    /// Publishes what has arrived since the last step. `now_ns` is the time.
    pub fn step(&mut self, time: StepTime, now_ns: u64) {
        let StepTime { due_ns, last_slot, origin_ns, newest_ns } = time;
        let (mut rounds, mut poses) = (Vec::new(), Vec::new());
        while let Ok(pose) = self.poses.pop() {
            self.records.send(&LoopRecord::Pose(pose));
            poses.push((&pose).into());
        }
        for bus in &mut self.rounds {
            while let Ok(round) = bus.pop() {
                self.records.send(&LoopRecord::Round(round));
                rounds.push((&round).into());
            }
        }
        let is_paused = self.vitals.is_stopped.load(Ordering::Acquire);
        let lost = self.records.lost();
        let input = StepInput { due_ns, started_ns: now_ns, last_slot, origin_ns, newest_ns, is_paused, lost };
        self.records.send(&LoopRecord::Step(input));
        let inputs = Inputs { session: self.session, sent_ns: now_ns, last_slot, origin_ns, rounds, poses };
        // Inputs have only keys that are text, and JSON has all of their values.
        if let Ok(payload) = serde_json::to_vec(&inputs) {
            let message = Message { topic: Arc::clone(&self.topic), payload, is_retained: Topic::Inputs.is_retained() };
            // A full queue means that the link hangs, and the controller notices that nothing arrives.
            let _ = self.messages.push(message);
            self.link.wake();
        }
    }
}
