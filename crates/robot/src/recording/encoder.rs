//! Records of the loop as messages.

use std::sync::Arc;

use serde::Serialize;
use vibrissa_runtime::machine::Program;

use super::channel::{Channel, Message};
use super::step_message::{PoseMessage, RoundMessage, StepMessage};
use super::tick_message::{EventMessage, PacketMessage, TickMessage};
use crate::drive::LoopRecord;

/// Converts records to messages. Rounds and poses wait for the step that takes them.
#[derive(Debug)]
pub(super) struct Encoder {
    program: Arc<Program>,
    poses: Vec<PoseMessage>,
    rounds: Vec<RoundMessage>,
    /// The next sequence number of each channel.
    sequences: [u32; Channel::ALL.len()],
}

impl Encoder {
    /// An encoder at the start of a run of this program.
    pub(super) fn new(program: Arc<Program>) -> Self {
        Self { program, poses: Vec::new(), rounds: Vec::new(), sequences: [0; Channel::ALL.len()] }
    }

    /// The message of a record, if it completes one.
    pub(super) fn encode(&mut self, record: &LoopRecord) -> Result<Option<Message>, serde_json::Error> {
        match record {
            LoopRecord::Round(round) => {
                self.rounds.push(round.into());
                Ok(None)
            }
            LoopRecord::Pose(pose) => {
                self.poses.push(pose.into());
                Ok(None)
            }
            LoopRecord::Step(input) => {
                let (poses, rounds) = (std::mem::take(&mut self.poses), std::mem::take(&mut self.rounds));
                self.message(Channel::Steps, input.started_ns, &StepMessage::new(input, poses, rounds))
            }
            LoopRecord::Tick(report) => {
                let message = TickMessage::new(report, &self.program);
                self.message(Channel::Ticks, report.started_ns, &message)
            }
            // A replay repeats the machine, and finds the same violations and messages.
            LoopRecord::Violation(_) | LoopRecord::Message(_) => Ok(None),
            LoopRecord::Event(event) => self.message(Channel::Events, event.time_ns, &EventMessage::from(event)),
            LoopRecord::Packet(packet) => self.message(Channel::Packets, packet.time_ns, &PacketMessage::from(packet)),
        }
    }

    fn message(
        &mut self,
        channel: Channel,
        time_ns: u64,
        content: &impl Serialize,
    ) -> Result<Option<Message>, serde_json::Error> {
        let data = serde_json::to_vec(content)?;
        let mut sequence = 0;
        if let Some(next) = self.sequences.get_mut(channel.index()) {
            sequence = *next;
            *next = next.wrapping_add(1);
        }
        Ok(Some(Message { channel, sequence, time_ns, data }))
    }
}
