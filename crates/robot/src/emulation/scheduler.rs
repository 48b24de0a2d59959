//! The scheduler of emulated time.

mod inject;

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use rtrb::{Consumer, Producer, RingBuffer};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Tick;
use vibrissa_runtime::signal::Command;

pub(super) use inject::Present;

use super::bus_thread::BusThread;
use super::injection::{Injection, InjectionKind};
use super::links::Links;
use super::pending_injection::PendingInjection;
use super::plant::{Plant, PlantFault};
use super::timeline::Timeline;
use crate::array::{Assembler, StampedPose, StartFault, ZeroingFault, period_ns};
use crate::config::{Config, ConfigError};
use crate::drive::{
    ControlTask, Inputs, LoopRecord, Outputs, QUEUE, RecordSender, Records, SUPERVISION_NS, Started, StepTime,
    Supervisor, record_queues, tick_offset_ns,
};
use crate::fault::FaultEvent;
use crate::link::{CommandPacket, StampedCommand};
use crate::sensor::Refused;
use crate::vitals::{Phase, Vitals};

/// Base angle of a whisker that is bent too far, as a ratio to the limit.
const OVERBENT: f64 = 1.03;

/// Properties of the emulated array.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Seed of all noise, and of the rates of the sensors' oscillators.
    pub seed: u64,
    /// Standard deviation of a sensor's noise (µT).
    pub noise_microtesla: f64,
    /// Faults to inject, in any order.
    pub injections: Vec<Injection>,
}

impl Default for Settings {
    /// The real sensor's noise, and no fault.
    fn default() -> Self {
        Self { seed: 0, noise_microtesla: 1.5, injections: Vec::new() }
    }
}

/// A robot in emulated time.
pub struct Emulation<P> {
    timeline: Rc<RefCell<Timeline<P>>>,
    buses: Vec<BusThread<P>>,
    control: ControlTask,
    control_thread: ControlThread,
    supervisor: Supervisor,
    vitals: Arc<Vitals>,
    poses: Producer<StampedPose>,
    commands: Consumer<StampedCommand>,
    records: Records,
    supervision_records: RecordSender,
    injections: Vec<PendingInjection>,
    present: Present,
    links: Links,
    /// Base moment (N m) of a whisker that is bent too far.
    overbent_moment: f64,
    sample_period_ns: u64,
    rounds_per_tick: u64,
    now_ns: u64,
    next_supervision_ns: u64,
    next_pose: u64,
    /// Time at which the machine has begun (ns).
    begun_ns: Option<u64>,
    last_packet: Option<CommandPacket>,
    events: Vec<FaultEvent>,
}

/// The control thread.
#[derive(Debug, Default)]
struct ControlThread {
    next_tick: u64,
    is_gone: bool,
}

/// A robot that cannot be emulated.
#[derive(Debug, thiserror::Error)]
pub enum EmulationError {
    /// A board has an address that the sensor cannot have.
    #[error(transparent)]
    Address(#[from] Refused),
    /// The sensor does not permit its settings.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A sensor cannot be started.
    #[error(transparent)]
    Start(#[from] StartFault),
    /// The neutral value of a whisker cannot be measured.
    #[error(transparent)]
    Zeroing(#[from] ZeroingFault),
}

/// The reason why [`Emulation::run`] has returned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stopped {
    /// The given time has passed.
    Time,
    /// The observer has ended the run.
    Observer,
    /// The simulation cannot go on.
    Plant(PlantFault),
}

impl<P: Plant> Emulation<P> {
    /// A robot with this configuration under `control`. Its body and whiskers are `plant`. All sensors are started.
    ///
    /// # Errors
    /// [`EmulationError`] if the configuration has no valid array.
    pub fn new(config: &Config, control: Control, plant: P, settings: &Settings) -> Result<Self, EmulationError> {
        let sensing = &config.rig.sensing;
        let sample_period_ns = period_ns(sensing.sample_rate);
        let sensor = config.sensor()?;
        let timeline = Rc::new(RefCell::new(Timeline::new(plant, sample_period_ns)));
        let vitals = Arc::new(Vitals::default());
        let (mut buses, mut consumers) = (Vec::new(), Vec::new());
        for (index, _) in (0_u8..).zip(&config.buses) {
            let (rounds, consumer) = RingBuffer::new(QUEUE);
            consumers.push(consumer);
            buses.push(BusThread::start(config, index, sensor, &timeline, settings, rounds)?);
        }
        let (pose_producer, pose_consumer) = RingBuffer::new(QUEUE);
        let (command_producer, commands) = RingBuffer::new(QUEUE);
        let ([control_records, supervision_records], records) = record_queues();
        let inputs = Inputs { rounds: consumers, poses: pose_consumer };
        let outputs = Outputs { commands: command_producer, records: control_records };
        let assembler = Assembler::new(config, &sensor);
        let stiffness = config.rig.whiskers.first().map_or(1.0, |whisker| whisker.hinge.stiffness);
        let mut injections: Vec<_> = settings.injections.iter().copied().map(PendingInjection::new).collect();
        injections.sort_by_key(|pending| pending.injection.at_ms);
        Ok(Self {
            timeline,
            buses,
            control: ControlTask::new(config, control, assembler, inputs, outputs, Arc::clone(&vitals)),
            control_thread: ControlThread { next_tick: 1, is_gone: false },
            supervisor: Supervisor::new(config),
            vitals,
            poses: pose_producer,
            commands,
            records,
            supervision_records,
            injections,
            present: Present::default(),
            links: Links::new(config),
            overbent_moment: OVERBENT * config.limits.base_angle * stiffness,
            sample_period_ns,
            rounds_per_tick: config.rounds_per_tick(),
            now_ns: 0,
            next_supervision_ns: 0,
            next_pose: 0,
            begun_ns: None,
            last_packet: None,
            events: Vec::new(),
        })
    }

    /// Changes of faults since the last call.
    pub fn take_events(&mut self) -> Vec<FaultEvent> {
        std::mem::take(&mut self.events)
    }

    /// The signs of life of the loop.
    #[must_use]
    pub fn vitals(&self) -> &Vitals {
        &self.vitals
    }

    /// Emulated time since the start (ns).
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        self.now_ns
    }

    /// Emulated time (ns) at which the machine has begun.
    #[must_use]
    pub fn begun_ns(&self) -> Option<u64> {
        self.begun_ns
    }

    /// The newest packet to the actuator.
    #[must_use]
    pub fn last_packet(&self) -> Option<&CommandPacket> {
        self.last_packet.as_ref()
    }

    /// The control loop.
    #[must_use]
    pub fn control(&self) -> &Control {
        self.control.control()
    }

    /// The next record of the loop. The queue keeps those of some seconds.
    pub fn next_record(&mut self) -> Option<LoopRecord> {
        self.records.next_record()
    }

    /// Runs until `until_ns` of emulated time, or until `observe` returns false. `observe` receives the control loop and
    /// the plant after every tick of the machine.
    ///
    /// # Errors
    /// [`EmulationError::Zeroing`] if a whisker is not at rest at the start.
    pub fn run(
        &mut self,
        until_ns: u64,
        mut observe: impl FnMut(&Control, Command, &Tick, &mut P) -> bool,
    ) -> Result<Stopped, EmulationError> {
        loop {
            let (time_ns, event) = self.next_event();
            if time_ns > until_ns {
                self.now_ns = until_ns;
                return Ok(Stopped::Time);
            }
            self.now_ns = self.now_ns.max(time_ns);
            match event {
                Event::Inject => self.inject(),
                Event::Acquire(bus) => {
                    if let Some(thread) = self.buses.get_mut(bus) {
                        thread.acquire(self.now_ns, self.sample_period_ns, &self.vitals);
                    }
                }
                Event::Deliver(bus) => {
                    if let Some(thread) = self.buses.get_mut(bus) {
                        thread.deliver(&self.vitals);
                    }
                }
                Event::Pose => self.pose(),
                Event::Supervise => self.supervise(),
                Event::Control => {
                    if !self.tick(&mut observe)? {
                        return Ok(Stopped::Observer);
                    }
                }
            }
            if let Some(fault) = self.timeline.borrow().fault.clone() {
                return Ok(Stopped::Plant(fault));
            }
        }
    }

    /// The next event and its time.
    fn next_event(&self) -> (u64, Event) {
        let mut next = (self.next_supervision_ns, Event::Supervise);
        let mut consider = |time_ns: u64, event: Event| {
            if time_ns < next.0 {
                next = (time_ns, event);
            }
        };
        consider(self.next_pose * self.sample_period_ns, Event::Pose);
        for (index, thread) in self.buses.iter().enumerate() {
            match &thread.pending {
                Some(round) => consider(round.ended_ns, Event::Deliver(index)),
                None => consider(thread.next_slot * self.sample_period_ns, Event::Acquire(index)),
            }
        }
        if !self.control_thread.is_gone && !self.present.has(InjectionKind::ControlStalls) {
            consider(self.tick_due_ns().max(self.now_ns), Event::Control);
        }
        if let Some(begun_ns) = self.begun_ns {
            for pending in &self.injections {
                if let Some(due_ns) = pending.due_ns(begun_ns) {
                    consider(due_ns.max(self.now_ns), Event::Inject);
                }
            }
        }
        next
    }

    fn tick_due_ns(&self) -> u64 {
        self.control_thread.next_tick * self.rounds_per_tick * self.sample_period_ns
            + tick_offset_ns(self.sample_period_ns)
    }

    fn pose(&mut self) {
        let time_ns = self.next_pose * self.sample_period_ns;
        self.next_pose += 1;
        let pose = self.timeline.borrow_mut().at(time_ns).pose;
        if let Some(pose) = self.links.pose(pose, self.now_ns, &self.present, &self.vitals) {
            let _ = self.poses.push(StampedPose { time_ns, pose });
        }
    }

    fn supervise(&mut self) {
        self.next_supervision_ns += SUPERVISION_NS;
        let mut command = None;
        while let Ok(newer) = self.commands.pop() {
            command = Some(newer);
        }
        let (events, records) = (&mut self.events, &mut self.supervision_records);
        let mut note = |event| {
            events.push(event);
            records.send(&LoopRecord::Event(event));
        };
        let acknowledged_ns = Some(self.links.acknowledged_ns(self.now_ns));
        let packet = self.supervisor.step(self.now_ns, &self.vitals, command, acknowledged_ns, &mut note);
        self.supervisor.sent(&packet, self.now_ns, &mut note);
        records.send(&LoopRecord::Packet(packet));
        self.links.send(&packet, self.now_ns, &self.present);
        if !self.present.has(InjectionKind::SilentActuator) {
            self.timeline.borrow_mut().command = packet.command;
        }
        self.last_packet = Some(packet);
    }

    fn tick(
        &mut self,
        observe: &mut impl FnMut(&Control, Command, &Tick, &mut P) -> bool,
    ) -> Result<bool, EmulationError> {
        let due_ns = self.tick_due_ns();
        let period_ns = self.rounds_per_tick * self.sample_period_ns;
        let missed = (self.now_ns - due_ns) / period_ns;
        self.vitals.miss(Phase::Control, missed);
        self.control_thread.next_tick += missed + 1;
        let last_slot = self.now_ns.saturating_sub(tick_offset_ns(self.sample_period_ns)) / self.sample_period_ns;
        let (now_ns, does_panic, mut ticked) = (self.now_ns, self.present.has(InjectionKind::ControlPanics), None);
        let now = || {
            assert!(!does_panic, "an injected fault");
            now_ns
        };
        let control = &mut self.control;
        let time = StepTime::new(due_ns, last_slot, 0, self.sample_period_ns);
        let step = || control.step(time, now, |_, command, tick| ticked = Some((command, *tick)));
        let Some(step) = self.vitals.guard(step) else {
            self.control_thread.is_gone = true;
            return Ok(true);
        };
        if step? == Started::Running && self.begun_ns.is_none() {
            self.begun_ns = Some(self.now_ns);
        }
        // Outside of the guard, so that a panic of the observer ends the run.
        let observe = |(command, tick)| {
            let plant = &mut self.timeline.borrow_mut().plant;
            plant.ticked(self.control.samples());
            observe(self.control.control(), command, &tick, plant)
        };
        Ok(ticked.is_none_or(observe))
    }
}

/// The events of the loop.
#[derive(Debug, Clone, Copy)]
enum Event {
    Inject,
    Acquire(usize),
    Deliver(usize),
    Pose,
    Supervise,
    Control,
}
