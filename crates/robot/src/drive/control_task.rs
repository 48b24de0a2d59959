//! The control task: one step per control period, from rounds and poses to a command.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use rtrb::{Consumer, Producer};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Status, Tick};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Sample};

use super::loop_record::{LoopRecord, RecordSender, StepInput, TimedMessage, Violation};
use super::report::TickReport;
use super::schedule::StepTime;
use super::violations::NewViolations;
use crate::array::{Assembler, PoseHistory, Round, StampedPose, Zeroing, ZeroingFault, period_ns};
use crate::config::Config;
use crate::link::StampedCommand;
use crate::vitals::Vitals;

/// Time (s) that the supervisor needs beyond a timeout until it has stopped the machine.
const STOPPING: f64 = 0.05;
/// Maximum number of messages of the policy that are passed on for one tick.
const MESSAGES_A_TICK: usize = 8;

/// The receiving ends of the control task.
#[derive(Debug)]
pub struct Inputs {
    /// The rounds of each bus.
    pub rounds: Vec<Consumer<Round>>,
    /// Poses.
    pub poses: Consumer<StampedPose>,
}

/// The sending ends of the control task.
#[derive(Debug)]
pub struct Outputs {
    /// Commands to the supervisor.
    pub commands: Producer<StampedCommand>,
    /// Records of the loop.
    pub records: RecordSender,
}

/// The control task.
#[derive(Debug)]
pub struct ControlTask {
    control: Control,
    assembler: Assembler,
    poses: PoseHistory,
    inputs: Inputs,
    outputs: Outputs,
    vitals: Arc<Vitals>,
    zeroing: Option<Zeroing>,
    sample_period_ns: u64,
    base_angle_limit: f64,
    /// Time during which the machine has waited (ns).
    paused_ns: u64,
    /// The last sample period of the previous tick.
    last_slot: u64,
}

/// The result of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Started {
    /// Neutral values are still measured.
    Zeroing,
    /// The machine runs, or waits while the robot is stopped.
    Running,
}

impl ControlTask {
    /// Creates the task. It begins with the measurement of the neutral values.
    #[must_use]
    pub fn new(
        config: &Config,
        mut control: Control,
        assembler: Assembler,
        inputs: Inputs,
        outputs: Outputs,
        vitals: Arc<Vitals>,
    ) -> Self {
        control.keep_for(kept_for(config));
        Self {
            control,
            zeroing: Some(assembler.zeroing()),
            assembler,
            poses: PoseHistory::new(pose_reach_ns(config)),
            inputs,
            outputs,
            vitals,
            sample_period_ns: period_ns(config.rig.sensing.sample_rate),
            base_angle_limit: config.limits.base_angle,
            paused_ns: 0,
            last_slot: 0,
        }
    }

    /// The control loop inside.
    #[must_use]
    pub fn control(&self) -> &Control {
        &self.control
    }

    /// The samples of the newest step, oldest first.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        self.assembler.newest_samples()
    }

    /// Executes a step, with the samples until its last sample period.
    ///
    /// `observe` receives the control loop after every tick of the machine. `now` gives the time.
    ///
    /// # Errors
    /// [`ZeroingFault`] if a whisker moves while its neutral value is measured.
    pub fn step(
        &mut self,
        time: StepTime,
        now: impl Fn() -> u64,
        mut observe: impl FnMut(&Control, Command, &Tick),
    ) -> Result<Started, ZeroingFault> {
        let StepTime { due_ns, last_slot, origin_ns, newest_ns } = time;
        let started_ns = now();
        self.take_poses();
        self.take_rounds();
        let is_paused = self.vitals.is_stopped.load(Ordering::Acquire);
        let lost = self.outputs.records.lost();
        let input = StepInput { due_ns, started_ns, last_slot, origin_ns, newest_ns, is_paused, lost };
        self.outputs.records.send(&LoopRecord::Step(input));
        if let Some(zeroing) = &self.zeroing {
            let Some(neutral) = zeroing.finish()? else {
                self.assembler.skip_to(last_slot + 1);
                self.last_slot = last_slot;
                return Ok(Started::Zeroing);
            };
            self.zeroing = None;
            self.assembler.set_neutral(neutral);
            self.assembler.skip_to(last_slot);
            self.last_slot = last_slot;
            // The time of the run begins now.
            self.paused_ns = last_slot.saturating_sub(1) * self.sample_period_ns;
            self.vitals.is_running.store(true, Ordering::Release);
        }
        if is_paused {
            self.paused_ns += (last_slot - self.last_slot.min(last_slot)) * self.sample_period_ns;
        }
        self.last_slot = last_slot;
        let samples = self.assembler.samples(last_slot, &self.poses, origin_ns, self.paused_ns);
        watch(samples, self.base_angle_limit, &self.vitals);
        let (mut command, mut status) = (Command::STOP, Status::Running);
        if !is_paused {
            let mut violations = NewViolations::default();
            let (next, tick) = self.control.tick_observed(samples, &mut violations);
            for contract in violations.contracts() {
                let violation = Violation { time_ns: started_ns, contract };
                self.outputs.records.send(&LoopRecord::Violation(violation));
            }
            for message in self.control.machine().logged().take(MESSAGES_A_TICK) {
                let message = TimedMessage { time_ns: started_ns, message };
                self.outputs.records.send(&LoopRecord::Message(message));
            }
            (command, status) = (next, tick.status);
            observe(&self.control, command, &tick);
            if status == Status::Failed {
                self.vitals.has_machine_failed.store(true, Ordering::Release);
            }
        }
        let ended_ns = now();
        self.vitals.tick_ns.store(ended_ns, Ordering::Release);
        self.vitals.tick_time.add(ended_ns.saturating_sub(started_ns));
        self.vitals.tick_lateness.add(started_ns.saturating_sub(due_ns));
        // Without room the supervisor is late, and its own watch reports that.
        let _ = self.outputs.commands.push(StampedCommand { time_ns: ended_ns, command });
        let sample_age_ns = started_ns.saturating_sub(newest_ns) + self.assembler.delay_ns();
        self.vitals.sample_age.add(sample_age_ns);
        self.report(TickReport {
            due_ns,
            started_ns,
            ended_ns,
            sample_age_ns,
            state: u16::try_from(self.control.machine().state()).unwrap_or(u16::MAX),
            status,
            pose: self.control.perception().pose(),
            base_angles: [0.0; MAX_WHISKERS],
            tips: [None; MAX_WHISKERS],
            command,
            is_paused,
        });
        Ok(Started::Running)
    }

    fn take_poses(&mut self) {
        while let Ok(stamped) = self.inputs.poses.pop() {
            self.outputs.records.send(&LoopRecord::Pose(stamped));
            self.poses.push(stamped);
        }
    }

    fn take_rounds(&mut self) {
        for bus in &mut self.inputs.rounds {
            while let Ok(round) = bus.pop() {
                self.outputs.records.send(&LoopRecord::Round(round));
                for (whisker, counts) in self.assembler.counts(&round) {
                    let Some(counts) = counts else { continue };
                    if let Some(zeroing) = &mut self.zeroing {
                        zeroing.take(whisker, counts);
                    } else {
                        let values = self.assembler.values(whisker, counts);
                        let is_finite = values.is_none_or(|(_, base_angle)| base_angle.is_finite());
                        self.vitals.angle_taken(whisker, is_finite);
                    }
                }
                self.assembler.take(&round);
            }
        }
    }

    fn report(&mut self, mut report: TickReport) {
        let perception = self.control.perception();
        for (bound, _) in perception.fitted() {
            if let (Some(angle), Some(tip)) = (report.base_angles.get_mut(bound), report.tips.get_mut(bound)) {
                *angle = perception.base_angle(bound);
                *tip = perception.recorded_tip(bound).filter(|_| !report.is_paused).map(|tip| [tip.x, tip.y]);
            }
        }
        self.outputs.records.send(&LoopRecord::Tick(report));
    }
}

/// For how long (s) the control of a robot keeps base angles and the pose over ticks without a valid one.
#[must_use]
pub fn kept_for(config: &Config) -> f64 {
    config.timeouts.sensor + STOPPING
}

/// Longest time (ns) over which a pose is extrapolated. Until the supervisor has stopped the machine, it always has one.
fn pose_reach_ns(config: &Config) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    let (timeout_ns, stopping_ns) = ((config.timeouts.pose * 1e9) as u64, (STOPPING * 1e9) as u64);
    timeout_ns.saturating_add(stopping_ns)
}

/// Marks whiskers whose base angle exceeds its limit, also those that the policy does not use.
fn watch(samples: &[Sample], limit: f64, vitals: &Vitals) {
    for whisker in 0..MAX_WHISKERS {
        let exceeds = |sample: &Sample| sample.whiskers.get(whisker).is_some_and(|w| w.base_angle.abs() > limit);
        if samples.iter().any(exceeds) {
            vitals.beyond_limit.fetch_or(1 << whisker, Ordering::AcqRel);
        }
    }
}
