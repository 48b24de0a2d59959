//! The scheduler of emulated time.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use embedded_hal::i2c::{ErrorType, I2c, Operation};
use rtrb::{Consumer, Producer, RingBuffer};
use vibrissa_mlx90393::InvalidAddress;
use vibrissa_mlx90393_emulator::{
    BusFault, EmulatedBus, EmulatedBusError, EmulatedSensor, FieldSource, SensorFault, SensorOptions,
};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::machine::Tick;
use vibrissa_runtime::signal::Command;

use super::injection::{Injection, InjectionKind};
use super::plant::{Plant, PlantFault};
use super::timeline::Timeline;
use crate::array::{Acquisition, Assembler, Bus, Magnet, Round, StampedPose, StartFault, ZeroingFault, period_ns};
use crate::config::{Config, ConfigError};
use crate::drive::{ControlTask, Inputs, Outputs, Supervisor, TickReport};
use crate::fault::FaultEvent;
use crate::link::{CommandPacket, StampedCommand};
use crate::vitals::{Phase, Vitals};

/// Period of the supervisor (ns).
const SUPERVISION_NS: u64 = 10_000_000;
/// Start of a control tick after that of its last round (ns), when the round has ended.
const TICK_OFFSET_NS: u64 = 1_500_000;
/// Base angle of a whisker that is bent too far, as a ratio to the limit.
const OVERBENT: f64 = 1.03;
/// Entries of a ring between two threads, for at least half a second.
const RING: usize = 256;

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
    reports: Consumer<TickReport>,
    injections: Vec<Pending>,
    switches: Switches,
    /// Base moment (N m) of a whisker that is bent too far.
    overbent_moment: f64,
    sample_period_ns: u64,
    rounds_per_tick: u64,
    now_ns: u64,
    next_supervision_ns: u64,
    next_pose: u64,
    acknowledged_ns: u64,
    /// Time at which the machine has begun (ns).
    begun_ns: Option<u64>,
    last_packet: Option<CommandPacket>,
    events: Vec<FaultEvent>,
}

/// An acquisition thread.
struct BusThread<P> {
    bus: TimedBus<P>,
    acquisition: Acquisition,
    rounds: Producer<Round>,
    whiskers: Vec<usize>,
    addresses: Vec<u8>,
    next_slot: u64,
    /// A round that has not ended yet.
    pending: Option<Round>,
}

/// The control thread.
#[derive(Debug, Default)]
struct ControlThread {
    next_tick: u64,
    is_gone: bool,
}

/// An injection and its progress.
#[derive(Debug, Clone, Copy)]
struct Pending {
    injection: Injection,
    is_injected: bool,
    is_cleared: bool,
}

/// Faults outside the buses that are present now.
#[derive(Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "independent switches")]
struct Switches {
    has_no_pose: bool,
    is_pose_invalid: bool,
    is_actuator_silent: bool,
    does_control_stall: bool,
}

/// An emulated bus with its own time.
struct TimedBus<P>(EmulatedBus<ArrayField<P>>);

impl<P> ErrorType for TimedBus<P> {
    type Error = EmulatedBusError;
}

impl<P: Plant> I2c for TimedBus<P> {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Self::Error> {
        self.0.transaction(address, operations)
    }
}

impl<P: Plant> Bus for TimedBus<P> {
    fn now_ns(&self) -> u64 {
        self.0.clock().now_ns()
    }

    fn pause_ns(&mut self, duration_ns: u64) {
        self.0.clock().advance_ns(duration_ns);
    }
}

/// A robot that cannot be emulated.
#[derive(Debug, thiserror::Error)]
pub enum EmulationError {
    /// A board has an address that the sensor cannot have.
    #[error(transparent)]
    Address(#[from] InvalidAddress),
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
    /// A robot with this configuration, controlled by `control`, in place of `plant`. All sensors are started.
    ///
    /// # Errors
    /// [`EmulationError`] if the configuration has no valid array.
    pub fn new(config: &Config, control: Control, plant: P, settings: &Settings) -> Result<Self, EmulationError> {
        let sensing = &config.rig.sensing;
        let sample_period_ns = period_ns(sensing.sample_rate);
        let checked = config.settings()?;
        let timeline = Rc::new(RefCell::new(Timeline::new(plant, sample_period_ns)));
        let vitals = Arc::new(Vitals::default());
        let (mut buses, mut consumers) = (Vec::new(), Vec::new());
        for (index, bus) in (0_u8..).zip(&config.buses) {
            let (producer, consumer) = RingBuffer::new(RING);
            consumers.push(consumer);
            let mut thread = BusThread {
                bus: TimedBus(emulated_bus(config, usize::from(index), &timeline, settings)),
                acquisition: Acquisition::new(index, bus, checked)?,
                rounds: producer,
                whiskers: config.whiskers_on(usize::from(index)),
                addresses: bus.boards.iter().map(|board| board.address).collect(),
                next_slot: 0,
                pending: None,
            };
            thread.acquisition.start(&mut thread.bus)?;
            // The first round begins after the bring-up.
            thread.next_slot = thread.bus.now_ns() / sample_period_ns + 1;
            buses.push(thread);
        }
        let (pose_producer, pose_consumer) = RingBuffer::new(RING);
        let (command_producer, commands) = RingBuffer::new(RING);
        let (report_producer, reports) = RingBuffer::new(RING);
        let inputs = Inputs { rounds: consumers, poses: pose_consumer };
        let outputs = Outputs { commands: command_producer, reports: report_producer };
        let conversion_ns = u64::from(checked.conversion_time().nominal_us) * 1000;
        let microtesla = f64::from(checked.field_per_count_microtesla(vibrissa_mlx90393::Axis::Y));
        let assembler = Assembler::new(config, microtesla, conversion_ns);
        let stiffness = config.rig.whiskers.first().map_or(1.0, |whisker| whisker.hinge.stiffness);
        let mut injections: Vec<Pending> = settings
            .injections
            .iter()
            .map(|&injection| Pending { injection, is_injected: false, is_cleared: false })
            .collect();
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
            reports,
            injections,
            switches: Switches::default(),
            overbent_moment: OVERBENT * config.limits.base_angle * stiffness,
            sample_period_ns,
            rounds_per_tick: config.rounds_per_tick(),
            now_ns: 0,
            next_supervision_ns: 0,
            next_pose: 0,
            acknowledged_ns: 0,
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

    /// The next report of a control tick.
    pub fn next_report(&mut self) -> Option<TickReport> {
        self.reports.pop().ok()
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
                Event::Acquire(bus) => self.acquire(bus),
                Event::Deliver(bus) => self.deliver(bus),
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
        if !self.control_thread.is_gone && !self.switches.does_control_stall {
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
        self.control_thread.next_tick * self.rounds_per_tick * self.sample_period_ns + TICK_OFFSET_NS
    }

    fn acquire(&mut self, bus: usize) {
        let Some(thread) = self.buses.get_mut(bus) else { return };
        thread.bus.0.clock().advance_to_ns(self.now_ns);
        let slot = thread.next_slot;
        let round = thread.acquisition.round(slot, &mut thread.bus);
        // A round that takes longer than a period misses the periods that begin meanwhile.
        let next = (round.ended_ns / self.sample_period_ns + 1).max(slot + 1);
        self.vitals.miss(Phase::Acquisition, next - slot - 1);
        thread.next_slot = next;
        thread.pending = Some(round);
    }

    fn deliver(&mut self, bus: usize) {
        let Some(thread) = self.buses.get_mut(bus) else { return };
        if let Some(round) = thread.pending.take() {
            self.vitals.round_ended(&round, &thread.whiskers);
            // A full ring means that control hangs, and its own watch reports that.
            let _ = thread.rounds.push(round);
        }
    }

    fn pose(&mut self) {
        let time_ns = self.next_pose * self.sample_period_ns;
        self.next_pose += 1;
        if self.switches.has_no_pose {
            return;
        }
        let pose =
            if self.switches.is_pose_invalid { Pose::UNKNOWN } else { self.timeline.borrow_mut().at(time_ns).pose };
        if self.vitals.pose_arrived(&pose, self.now_ns) {
            let _ = self.poses.push(StampedPose { time_ns, pose });
        }
    }

    fn supervise(&mut self) {
        self.next_supervision_ns += SUPERVISION_NS;
        let mut command = None;
        while let Ok(newer) = self.commands.pop() {
            command = Some(newer);
        }
        let events = &mut self.events;
        let acknowledged_ns = Some(self.acknowledged_ns);
        let packet =
            self.supervisor.step(self.now_ns, &self.vitals, command, acknowledged_ns, |event| events.push(event));
        self.supervisor.sent(&packet, self.now_ns, |event| events.push(event));
        if !self.switches.is_actuator_silent {
            self.acknowledged_ns = self.now_ns;
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
        let last_slot = (self.now_ns - TICK_OFFSET_NS.min(self.now_ns)) / self.sample_period_ns;
        let (now_ns, mut goes_on) = (self.now_ns, true);
        let timeline = &self.timeline;
        let step = self.control.step(
            due_ns,
            last_slot,
            0,
            || now_ns,
            |control, command, tick| {
                goes_on = observe(control, command, tick, &mut timeline.borrow_mut().plant);
            },
        )?;
        if step == crate::drive::Started::Running && self.begun_ns.is_none() {
            self.begun_ns = Some(self.now_ns);
        }
        Ok(goes_on)
    }

    /// Injects and clears the faults that are due.
    fn inject(&mut self) {
        let Some(begun_ns) = self.begun_ns else { return };
        let due: Vec<usize> = (0..self.injections.len())
            .filter(|&index| self.injections[index].due_ns(begun_ns).is_some_and(|due_ns| due_ns <= self.now_ns))
            .collect();
        for index in due {
            let Some(pending) = self.injections.get_mut(index) else { continue };
            let injection = pending.injection;
            let begins = !pending.is_injected;
            if begins {
                pending.is_injected = true;
            } else {
                pending.is_cleared = true;
            }
            self.switch(injection, begins);
        }
    }

    fn switch(&mut self, injection: Injection, begins: bool) {
        let part = injection.part;
        match injection.kind {
            InjectionKind::StaleSensor => self.sensor_fault(part, begins, SensorFault::ClockStopped),
            InjectionKind::BrownOut if begins => self.sensor_fault(part, true, SensorFault::BrownOut),
            InjectionKind::BrownOut => {}
            InjectionKind::NoAcknowledge => {
                self.sensor_fault(part, begins, SensorFault::NoAcknowledge { transactions: None });
            }
            InjectionKind::GarbledBytes => {
                self.sensor_fault(part, begins, SensorFault::BitFlip { byte: 0, mask: 0x0C, answers: u32::MAX });
            }
            InjectionKind::SaturatedField => {
                self.sensor_fault(part, begins, SensorFault::Saturated { negative: false });
            }
            InjectionKind::OverbentWhisker => {
                if let Some(bent) = self.timeline.borrow_mut().bent.get_mut(usize::from(part)) {
                    *bent = begins.then_some(self.overbent_moment);
                }
            }
            InjectionKind::StuckBus => {
                let count = self.buses.len();
                if let Some(thread) = self.buses.get_mut(usize::from(part) % count.max(1)) {
                    if begins { thread.bus.0.inject(BusFault::STUCK) } else { thread.bus.0.clear() }
                }
            }
            InjectionKind::NoPose => self.switches.has_no_pose = begins,
            InjectionKind::PoseNotANumber => self.switches.is_pose_invalid = begins,
            InjectionKind::SilentActuator => self.switches.is_actuator_silent = begins,
            InjectionKind::NoBroker => self.vitals.is_broker_gone.store(begins, Ordering::Release),
            InjectionKind::ControlStalls => self.switches.does_control_stall = begins,
            InjectionKind::ControlPanics => {
                self.control_thread.is_gone = true;
                self.vitals.has_panicked.store(true, Ordering::Release);
            }
            InjectionKind::MachineFails => self.vitals.has_machine_failed.store(true, Ordering::Release),
            InjectionKind::Terminate => self.vitals.is_terminated.store(true, Ordering::Release),
        }
    }

    fn sensor_fault(&mut self, whisker: u8, begins: bool, fault: SensorFault) {
        for thread in &mut self.buses {
            let Some(board) = thread.whiskers.iter().position(|&index| index == usize::from(whisker)) else { continue };
            let Some(&address) = thread.addresses.get(board) else { continue };
            let bus = &mut thread.bus.0;
            let changed = if begins { bus.inject_at(address, fault) } else { bus.clear_at(address) };
            // Every address of the configuration has a sensor.
            debug_assert!(changed.is_ok());
        }
    }
}

impl Pending {
    /// Time (ns) of the next change, if there is one.
    fn due_ns(&self, begun_ns: u64) -> Option<u64> {
        let Injection { at_ms, for_ms, .. } = self.injection;
        let at_ns = begun_ns + at_ms * 1_000_000;
        match (self.is_injected, self.is_cleared) {
            (false, _) => Some(at_ns),
            (true, false) => Some(at_ns + for_ms * 1_000_000),
            (true, true) => None,
        }
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

/// The fields at the sensors of a bus: those of the plant's base moments, along Y.
struct ArrayField<P> {
    timeline: Rc<RefCell<Timeline<P>>>,
    /// The whisker of each sensor, and its magnet.
    magnets: Vec<(usize, Magnet)>,
}

impl<P: Plant> FieldSource for ArrayField<P> {
    fn field_microtesla(&mut self, sensor: usize, time_ns: u64) -> [f64; 3] {
        let Some((whisker, magnet)) = self.magnets.get(sensor) else { return [0.0; 3] };
        let moments = self.timeline.borrow_mut().at(time_ns).base_moments;
        [0.0, magnet.field_microtesla(moments.get(*whisker).copied().unwrap_or(0.0)), 0.0]
    }
}

/// A bus with the boards of the configuration.
fn emulated_bus<P: Plant>(
    config: &Config,
    bus: usize,
    timeline: &Rc<RefCell<Timeline<P>>>,
    settings: &Settings,
) -> EmulatedBus<ArrayField<P>> {
    let boards: Vec<_> = config.boards().filter(|board| board.0 == bus).collect();
    let magnets = boards.iter().filter_map(|&(bus, board, whisker)| {
        let board = config.buses.get(bus)?.boards.get(board)?;
        Some((whisker, Magnet { field_per_moment: board.field_per_moment, cubic: board.cubic }))
    });
    let magnets = magnets.collect();
    let mut emulated = EmulatedBus::new(ArrayField { timeline: Rc::clone(timeline), magnets });
    for (field_index, &(bus, board, whisker)) in boards.iter().enumerate() {
        let Some(board) = config.buses.get(bus).and_then(|bus| bus.boards.get(board)) else { continue };
        // Oscillators differ by up to 10 %, and offsets by hundreds of counts.
        let spread = f64::from(u32::try_from((settings.seed * 7 + whisker as u64 * 3) % 9).unwrap_or(0)) / 4.0 - 1.0;
        emulated.add(EmulatedSensor::new(SensorOptions {
            address: board.address,
            field_index,
            clock_ratio: 1.0 + 0.1 * spread,
            noise_microtesla: [settings.noise_microtesla; 3],
            offset_microtesla: [0.0, 60.0 * spread, 0.0],
            seed: settings.seed.wrapping_mul(31).wrapping_add(whisker as u64),
            ..SensorOptions::default()
        }));
    }
    emulated
}
