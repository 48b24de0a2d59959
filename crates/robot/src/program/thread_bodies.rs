//! The bodies of the threads.

use std::sync::atomic::Ordering;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use rtrb::{Consumer, Producer};

use super::real_time::{ACQUISITION_PRIORITY, CONTROL_PRIORITY, SUPERVISION_PRIORITY, raise_priority};
use super::threads::{Common, PoseReceiver, ThreadError};
use crate::array::{Acquisition, Bus, Round, StampedPose};
use crate::drive::{
    ControlTask, LoopRecord, RecordSender, RecordSink, Records, SUPERVISION_NS, StepTime, Supervisor, tick_offset_ns,
};
use crate::link::{Actuator, CommandPacket, PoseGate, ReceivedPose, StampedCommand};
use crate::services::{InputTask, RemoteCommands};
use crate::vitals::Phase;

/// Time between looks at the queue of records.
const TELEMETRY_PERIOD: Duration = Duration::from_millis(10);
/// The longest wait for inputs, after which the thread looks whether it must end.
const INPUTS_LOOK: Duration = Duration::from_millis(20);

pub(super) fn acquire<B: Bus>(
    common: &Common,
    mut bus: B,
    mut acquisition: Acquisition,
    whiskers: &[usize],
    mut rounds: Producer<Round>,
) {
    raise_priority(ACQUISITION_PRIORITY);
    if let Err(error) = acquisition.start(&mut bus) {
        // The receiver is gone only if the program ends anyway.
        let _ = common.errors.send(error.into());
        return;
    }
    let mut slot = 0;
    while common.goes_on() {
        let now_ns = common.clock.now_ns();
        let current = now_ns.saturating_sub(common.origin_ns) / common.sample_period_ns;
        // After a long call, the periods that it has covered are missed.
        let next = slot.max(current);
        common.vitals.miss(Phase::Acquisition, next - slot);
        slot = next;
        let due_ns = common.origin_ns + slot * common.sample_period_ns;
        common.clock.sleep_until_ns(due_ns);
        let round = acquisition.round(slot, &mut bus);
        common.vitals.round_ended(&round, whiskers);
        if let Some(time) = common.vitals.round_time.get(usize::from(round.bus)) {
            time.add(round.ended_ns.saturating_sub(due_ns));
        }
        // A full ring means that its reader hangs, which the supervisor sees.
        let _ = rounds.push(round);
        slot += 1;
    }
}

/// Calls `step` once per control period with its time, as long as the result is true.
fn control_periods(common: &Common, tick_periods: u64, mut step: impl FnMut(StepTime) -> bool) {
    raise_priority(CONTROL_PRIORITY);
    let period_ns = tick_periods * common.sample_period_ns;
    let offset_ns = tick_offset_ns(common.sample_period_ns);
    let mut tick = 1;
    while common.goes_on() {
        let due_ns = common.origin_ns + tick * period_ns + offset_ns;
        let now_ns = common.clock.now_ns();
        let missed = now_ns.saturating_sub(due_ns) / period_ns;
        common.vitals.miss(Phase::Control, missed);
        tick += missed;
        let due_ns = due_ns + missed * period_ns;
        common.clock.sleep_until_ns(due_ns);
        if !step(StepTime::new(due_ns, tick * tick_periods, common.origin_ns, common.sample_period_ns)) {
            return;
        }
        tick += 1;
    }
}

/// The control task on its own schedule.
pub(super) fn control(common: &Common, mut task: ControlTask, tick_periods: u64) {
    let mut has_failed = false;
    control_periods(common, tick_periods, |time| control_step(common, &mut task, time, &mut has_failed));
}

/// The control task on the schedule of the sensor IO. Steps that have been missed are left out, as on its own schedule.
pub(super) fn control_by_inputs(common: &Common, mut task: ControlTask, steps: &Receiver<StepTime>) {
    raise_priority(CONTROL_PRIORITY);
    let mut has_failed = false;
    while common.goes_on() {
        let Ok(mut time) = steps.recv_timeout(INPUTS_LOOK) else { continue };
        while let Ok(newer) = steps.try_recv() {
            common.vitals.miss(Phase::Control, 1);
            time = newer;
        }
        if !control_step(common, &mut task, time, &mut has_failed) {
            return;
        }
    }
}

/// Publishes the inputs of the control task on its schedule.
pub(super) fn publish_inputs(common: &Common, mut task: InputTask, tick_periods: u64) {
    control_periods(common, tick_periods, |time| {
        task.step(time, common.clock.now_ns());
        true
    });
}

/// Executes a step. False if the task has ended.
fn control_step(common: &Common, task: &mut ControlTask, time: StepTime, has_failed: &mut bool) -> bool {
    let clock = common.clock;
    match task.step(time, || clock.now_ns(), |_, _, _| {}) {
        Ok(_) => {
            if let (Some(failure), false) = (task.control().machine().failure(), *has_failed) {
                *has_failed = true;
                let _ = common.errors.send(ThreadError::Machine(failure.to_string()));
            }
            true
        }
        Err(error) => {
            let _ = common.errors.send(error.into());
            false
        }
    }
}

/// The source of the supervisor's commands.
pub(super) trait CommandSource {
    /// The newest command since the last call.
    fn newest(&mut self, now_ns: u64) -> Option<StampedCommand>;

    /// The packet of the supervisor as it is sent.
    fn forwarded(&self, packet: CommandPacket) -> CommandPacket {
        packet
    }

    /// The packet has been sent. `is_stopped` is true while the supervisor stops the robot.
    fn sent(&mut self, is_stopped: bool) {
        let _ = is_stopped;
    }
}

impl CommandSource for Consumer<StampedCommand> {
    fn newest(&mut self, _now_ns: u64) -> Option<StampedCommand> {
        std::iter::from_fn(|| self.pop().ok()).last()
    }
}

impl CommandSource for RemoteCommands {
    fn newest(&mut self, now_ns: u64) -> Option<StampedCommand> {
        self.take(now_ns)
    }

    fn forwarded(&self, packet: CommandPacket) -> CommandPacket {
        self.forwarded(packet)
    }

    fn sent(&mut self, is_stopped: bool) {
        self.acknowledge(is_stopped);
    }
}

pub(super) fn supervise(
    common: &Common,
    mut supervisor: Supervisor,
    mut actuator: Box<dyn Actuator>,
    mut commands: impl CommandSource,
    mut records: RecordSender,
) {
    raise_priority(SUPERVISION_PRIORITY);
    let mut due_ns = common.clock.now_ns();
    // The stop at the end of the program is sent as well.
    let mut has_ended = false;
    while !has_ended {
        has_ended = !common.goes_on();
        if has_ended {
            common.vitals.is_terminated.store(true, Ordering::Release);
        }
        let now_ns = common.clock.now_ns();
        let command = commands.newest(now_ns);
        let acknowledged_ns = actuator.acknowledged_ns(now_ns);
        let mut log = |event| records.send(&LoopRecord::Event(event));
        let packet = supervisor.step(now_ns, &common.vitals, command, acknowledged_ns, &mut log);
        let packet = commands.forwarded(packet);
        // The missing acknowledgement tells a command that cannot be sent.
        let _ = actuator.send(&packet);
        commands.sent(supervisor.is_stopped());
        supervisor.sent(&packet, common.clock.now_ns(), &mut log);
        records.send(&LoopRecord::Packet(packet));
        common.vitals.supervised_ns.store(now_ns, Ordering::Release);
        due_ns += SUPERVISION_NS;
        let late_periods = common.clock.now_ns().saturating_sub(due_ns) / SUPERVISION_NS;
        common.vitals.miss(Phase::Supervision, late_periods);
        due_ns += late_periods * SUPERVISION_NS;
        common.clock.sleep_until_ns(due_ns);
    }
}

pub(super) fn receive_poses(
    common: &Common,
    mut receive: PoseReceiver,
    mut gate: PoseGate,
    latency: f64,
    mut poses: Producer<StampedPose>,
) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    let latency_ns = (latency * 1e9) as u64;
    while common.goes_on() {
        let packet = match receive() {
            Some(ReceivedPose::Packet(packet)) => packet,
            Some(ReceivedPose::Foreign) => {
                common.vitals.foreign_packet();
                continue;
            }
            None => continue,
        };
        let now_ns = common.clock.now_ns();
        if let Some(pose) = gate.take(&packet, now_ns, &common.vitals) {
            let _ = poses.push(StampedPose { time_ns: now_ns.saturating_sub(latency_ns), pose });
        }
    }
}

pub(super) fn pass_on(common: &Common, mut records: Records, mut sinks: Vec<Box<dyn RecordSink>>) {
    // It outlives the threads that record, so that their last records are passed on.
    while !records.have_ended() {
        std::thread::sleep(TELEMETRY_PERIOD);
        while let Some(record) = records.next_record() {
            for sink in &mut sinks {
                sink.take(&record);
            }
        }
        let now_ns = common.clock.now_ns();
        for sink in &mut sinks {
            sink.pause(now_ns, &common.vitals);
        }
    }
    for sink in &mut sinks {
        sink.finish();
    }
}
