//! Records of the loop, for the log, telemetry and recordings.

use rtrb::{Consumer, Producer};
use vibrissa_runtime::machine::{ContractId, LoggedMessage};

use super::report::TickReport;
use crate::array::{Round, StampedPose};
use crate::fault::FaultEvent;
use crate::link::CommandPacket;

/// One entry of the loop's history. It has a fixed size, so that recording allocates no memory.
///
/// The control task writes its inputs in the order in which it takes them: the rounds and poses since the last step, then
/// the step. So the records are sufficient to repeat every command.
#[derive(Debug, Clone, Copy)]
pub enum LoopRecord {
    /// The control task has taken a round.
    Round(Round),
    /// The control task has taken a pose.
    Pose(StampedPose),
    /// The control task begins a step.
    Step(StepInput),
    /// A step has executed the machine, or would have without a stop.
    Tick(TickReport),
    /// The machine begins to violate a contract of its policy.
    Violation(Violation),
    /// The policy has logged a message.
    Message(TimedMessage),
    /// A fault has changed.
    Event(FaultEvent),
    /// The supervisor has sent a packet.
    Packet(CommandPacket),
}

/// The beginning of a violation of a contract.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Violation {
    /// Start of the step (ns).
    pub time_ns: u64,
    /// The contract.
    pub contract: ContractId,
}

/// A message of the policy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedMessage {
    /// Start of the step (ns).
    pub time_ns: u64,
    /// The message with its values.
    pub message: LoggedMessage,
}

/// The inputs of a step of the control task, except rounds and poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StepInput {
    /// Scheduled time of the step since the start of the program (ns).
    pub due_ns: u64,
    /// Start of the step (ns).
    pub started_ns: u64,
    /// The last sample period of the step.
    pub last_slot: u64,
    /// Time of the sample period with the number 0 (ns), on the clock of the poses.
    pub origin_ns: u64,
    /// Start of the last sample period (ns), on the clock of the step.
    pub newest_ns: u64,
    /// True if the supervisor stops the robot, so that the machine waits.
    pub is_paused: bool,
    /// Records of the control task that have been lost until now, because the queue was full.
    pub lost: u64,
}

/// The sending end of a queue of records. A full queue loses the newest entry and counts it.
#[derive(Debug)]
pub struct RecordSender {
    producer: Producer<LoopRecord>,
    lost: u64,
}

/// The receiving ends of all queues of records.
#[derive(Debug)]
pub struct Records(Vec<Consumer<LoopRecord>>);

impl RecordSender {
    pub(crate) fn send(&mut self, record: &LoopRecord) {
        if self.producer.push(*record).is_err() {
            self.lost += 1;
        }
    }

    /// Records that have been lost.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }
}

impl Records {
    /// The next record. The order is that of the control task, and that of the supervisor, but not between both.
    pub fn next_record(&mut self) -> Option<LoopRecord> {
        self.0.iter_mut().find_map(|queue| queue.pop().ok())
    }

    /// True if all senders are gone and all records have been taken.
    #[must_use]
    pub fn have_ended(&self) -> bool {
        self.0.iter().all(|queue| queue.is_abandoned() && queue.is_empty())
    }
}

/// Number of records in a queue. With four buses at 300 Hz and poses at 1 kHz, it is full after almost two seconds.
const CAPACITY: usize = 4096;

/// Creates the queues of the control task and of the supervisor, in this order.
#[must_use]
pub fn record_queues() -> ([RecordSender; 2], Records) {
    let (control, from_control) = rtrb::RingBuffer::new(CAPACITY);
    let (supervision, from_supervision) = rtrb::RingBuffer::new(CAPACITY);
    let sender = |producer| RecordSender { producer, lost: 0 };
    ([sender(control), sender(supervision)], Records(vec![from_control, from_supervision]))
}
