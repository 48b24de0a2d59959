//! Translation of the loop's records to payloads.

use vibrissa_runtime::geometry::Pose as Platform;
use vibrissa_runtime::machine::{Program, Status};
use vibrissa_runtime::signal::Command;

use super::payload::{
    BusSamples, CommandLog, Fault, FaultNote, Motion, PerceivedWhisker, Perception, Pose, Samples, SentPacket, State,
    WhiskerSamples,
};
use super::telemetry_sink::seconds;
use crate::array::{Assembler, Round, Zeroing};
use crate::config::{Config, MAX_ROUNDS};
use crate::drive::{LoopRecord, TickReport};
use crate::fault::{self, FaultChange, FaultEvent, FaultKind};
use crate::link::CommandPacket;

/// Packets in one message. In a control period there are fewer.
const MOST_PACKETS: usize = 32;

/// A payload.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Note {
    State(State),
    Samples(Samples),
    Perception(Perception),
    CommandLog(CommandLog),
    Fault(FaultNote),
}

/// Translates records, and keeps what payloads need from earlier ones.
#[derive(Debug)]
pub(super) struct Translator {
    /// Names of the whiskers in the rig.
    rig_whiskers: Vec<String>,
    /// Names of the whiskers in the policy, if the rig has them.
    policy_whiskers: Vec<Option<String>>,
    /// Device files.
    buses: Vec<String>,
    /// Names of the states of the machine.
    states: Vec<String>,
    /// It converts counts only.
    assembler: Option<Assembler>,
    /// It repeats the measurement of the control task.
    zeroing: Option<Zeroing>,
    is_zeroed: bool,
    samples: Vec<BusSamples>,
    packets: Vec<SentPacket>,
    state: State,
    faults: Vec<Fault>,
    lost_records: u64,
}

impl Translator {
    pub(super) fn new(config: &Config, program: Option<&Program>) -> Self {
        let rig_whiskers: Vec<_> = config.rig.whiskers.iter().map(|whisker| whisker.name.clone()).collect();
        let fitted = |name: &String| rig_whiskers.contains(name).then(|| name.clone());
        // The loop does not start with other settings.
        let assembler = config.sensor().ok().map(|sensor| Assembler::new(config, &sensor));
        Self {
            policy_whiskers: program.iter().flat_map(|program| &program.whiskers).map(fitted).collect(),
            buses: config.buses.iter().map(|bus| bus.device.display().to_string()).collect(),
            states: program.iter().flat_map(|program| &program.states).map(|state| state.name.to_string()).collect(),
            zeroing: assembler.as_ref().map(Assembler::zeroing),
            assembler,
            is_zeroed: false,
            rig_whiskers,
            samples: Vec::new(),
            packets: Vec::new(),
            state: State {
                policy: program.map_or_else(String::new, |program| program.name.clone()),
                state: None,
                has_failed: false,
                is_paused: false,
            },
            faults: Vec::new(),
            lost_records: 0,
        }
    }

    /// The state of the machine.
    pub(super) fn state(&self) -> State {
        self.state.clone()
    }

    /// The faults that are present.
    pub(super) fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Records of the control task that have been lost.
    pub(super) fn lost_records(&self) -> u64 {
        self.lost_records
    }

    /// Takes the next record. `send` receives the payloads that are complete now, with their times (ns).
    pub(super) fn take(&mut self, record: &LoopRecord, send: &mut impl FnMut(u64, Note)) {
        match record {
            LoopRecord::Round(round) => {
                self.round(round);
                if self.samples.iter().any(|bus| bus.time_s.len() >= MAX_ROUNDS as usize) {
                    self.send_samples(round.ended_ns, send);
                }
            }
            LoopRecord::Pose(_) | LoopRecord::Violation(_) | LoopRecord::Message(_) => {}
            LoopRecord::Step(step) => {
                self.lost_records = step.lost;
                self.zero();
                self.send_samples(step.started_ns, send);
            }
            LoopRecord::Tick(tick) => self.tick(tick, send),
            LoopRecord::Event(event) => self.event(*event, send),
            LoopRecord::Packet(packet) => {
                self.packets.push(sent(packet));
                if self.packets.len() >= MOST_PACKETS {
                    let packets = std::mem::take(&mut self.packets);
                    send(packet.time_ns, Note::CommandLog(CommandLog { machine: None, packets }));
                }
            }
        }
    }

    /// The packets that no message has yet.
    pub(super) fn rest(&mut self) -> Option<Note> {
        let packets = std::mem::take(&mut self.packets);
        (!packets.is_empty()).then_some(Note::CommandLog(CommandLog { machine: None, packets }))
    }

    fn round(&mut self, round: &Round) {
        let (Some(assembler), Some(bus)) = (&self.assembler, self.buses.get(usize::from(round.bus))) else { return };
        let values: Vec<_> = assembler.counts(round).collect();
        if let Some(zeroing) = &mut self.zeroing {
            for &(whisker, counts) in &values {
                if let Some(counts) = counts {
                    zeroing.take(whisker, counts);
                }
            }
        }
        let index = self.samples.iter().position(|samples| samples.bus == *bus).unwrap_or_else(|| {
            let whisker = |(whisker, _): &(usize, Option<i32>)| WhiskerSamples {
                whisker: self.rig_whiskers.get(*whisker).cloned().unwrap_or_default(),
                field_t: Vec::new(),
                base_angle_rad: Vec::new(),
            };
            let whiskers = values.iter().map(whisker).collect();
            self.samples.push(BusSamples { bus: bus.clone(), time_s: Vec::new(), whiskers });
            self.samples.len() - 1
        });
        let Some(samples) = self.samples.get_mut(index) else { return };
        samples.time_s.push(seconds(round.started_ns));
        for (samples, (whisker, counts)) in samples.whiskers.iter_mut().zip(values) {
            let values = counts.and_then(|counts| assembler.values(whisker, counts));
            samples.field_t.push(values.map(|(field, _)| field));
            let angle = values.map(|(_, angle)| angle).filter(|_| self.is_zeroed);
            samples.base_angle_rad.push(angle.and_then(finite));
        }
    }

    /// Takes the neutral values once they have been measured.
    fn zero(&mut self) {
        let Some(zeroing) = &self.zeroing else { return };
        match zeroing.finish() {
            Ok(Some(neutral)) => {
                if let Some(assembler) = &mut self.assembler {
                    assembler.set_neutral(neutral);
                }
                (self.zeroing, self.is_zeroed) = (None, true);
            }
            Ok(None) => {}
            // The control task reports the fault and ends the program.
            Err(_) => self.zeroing = None,
        }
    }

    fn send_samples(&mut self, time_ns: u64, send: &mut impl FnMut(u64, Note)) {
        let buses = std::mem::take(&mut self.samples);
        if !buses.is_empty() {
            send(time_ns, Note::Samples(Samples { buses }));
        }
    }

    fn tick(&mut self, tick: &TickReport, send: &mut impl FnMut(u64, Note)) {
        let time_ns = tick.started_ns;
        // While the machine waits, its perception is that of the last tick.
        if !tick.is_paused {
            send(time_ns, Note::Perception(self.perception(tick)));
        }
        let machine = (!tick.is_paused).then(|| motion(&tick.command));
        let packets = std::mem::take(&mut self.packets);
        send(time_ns, Note::CommandLog(CommandLog { machine, packets }));
        let state = State {
            policy: self.state.policy.clone(),
            state: self.states.get(usize::from(tick.state)).cloned(),
            has_failed: self.state.has_failed || tick.status == Status::Failed,
            is_paused: tick.is_paused,
        };
        if state != self.state {
            self.state = state.clone();
            send(time_ns, Note::State(state));
        }
    }

    fn perception(&self, tick: &TickReport) -> Perception {
        let perceived = self.policy_whiskers.iter().zip(tick.base_angles.iter().zip(&tick.tips));
        let whiskers = perceived.filter_map(|(name, (angle, tip))| {
            Some(PerceivedWhisker { whisker: name.clone()?, base_angle_rad: finite(*angle), tip_m: *tip })
        });
        let (pose, sample_age_s) = (pose(&tick.pose), seconds(tick.sample_age_ns));
        Perception { pose, whiskers: whiskers.collect(), sample_age_s }
    }

    fn event(&mut self, event: FaultEvent, send: &mut impl FnMut(u64, Note)) {
        let fault = Fault { fault: event.fault.kind, part: self.part(event.fault) };
        match event.change {
            FaultChange::Detected => self.faults.push(fault.clone()),
            FaultChange::Reacted => {}
            FaultChange::Recovered => self.faults.retain(|present| *present != fault),
        }
        send(event.time_ns, Note::Fault(FaultNote { fault, change: event.change }));
    }

    fn part(&self, fault: fault::Fault) -> Option<String> {
        let part = usize::from(fault.part);
        match fault.kind {
            FaultKind::SensorStale
            | FaultKind::SensorLost
            | FaultKind::InvalidReading
            | FaultKind::Saturated
            | FaultKind::AngleLimit => self.rig_whiskers.get(part).cloned(),
            FaultKind::BusBlocked => self.buses.get(part).cloned(),
            FaultKind::PoseOld
            | FaultKind::PoseJump
            | FaultKind::PoseRestarted
            | FaultKind::ForeignSender
            | FaultKind::LinkLost
            | FaultKind::BrokerGone
            | FaultKind::ControlLate
            | FaultKind::MachineFailed
            | FaultKind::Panic
            | FaultKind::Terminated => None,
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn pose(pose: &Platform) -> Option<Pose> {
    pose.is_finite().then_some(Pose { position_m: [pose.position.x, pose.position.y], heading_rad: pose.heading })
}

fn motion(command: &Command) -> Motion {
    let velocity = command.velocity_world;
    Motion { velocity_m_per_s: [velocity.x, velocity.y], yaw_rate_rad_per_s: command.yaw_rate }
}

fn sent(packet: &CommandPacket) -> SentPacket {
    SentPacket {
        packet: packet.sequence,
        time_s: seconds(packet.time_ns),
        motion: motion(&packet.command),
        is_stop: packet.is_stop,
    }
}
