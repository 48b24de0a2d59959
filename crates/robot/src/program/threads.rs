//! The threads of the loop.

use std::cell::OnceCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Once};
use std::thread::JoinHandle;

use rtrb::{Consumer, Producer, RingBuffer};
use vibrissa_runtime::control::Control;

use super::real_time::{ACQUISITION_PRIORITY, CONTROL_PRIORITY, SUPERVISION_PRIORITY, raise_priority};
use super::system_clock::SystemClock;
use crate::array::{Acquisition, Assembler, Bus, Round, StampedPose, StartFault, ZeroingFault, period_ns};
use crate::config::{Config, ConfigError};
use crate::drive::{
    ControlTask, Inputs, LoopRecord, Outputs, QUEUE, RecordSender, RecordSink, Records, SUPERVISION_NS, Supervisor,
    record_queues, tick_offset_ns,
};
use crate::link::{Actuator, StampedCommand};
use crate::vitals::{Phase, Vitals};

/// Time (ns) from the start of the threads to the first round, so that all threads are ready.
const LEAD_NS: u64 = 20_000_000;

/// Time between looks at the queue of records.
const TELEMETRY_PERIOD: std::time::Duration = std::time::Duration::from_millis(10);

/// A source of poses. It waits for at most some milliseconds.
pub type PoseReceiver = Box<dyn FnMut() -> Option<vibrissa_runtime::geometry::Pose> + Send>;

/// Everything that the threads need.
pub struct Robot<B> {
    /// The configuration.
    pub config: Config,
    /// The control loop.
    pub control: Control,
    /// One opener for each bus. It runs on the thread of the bus.
    pub buses: Vec<Box<dyn FnOnce() -> B + Send>>,
    /// The receiver of commands.
    pub actuator: Box<dyn Actuator>,
    /// The source of poses.
    pub poses: PoseReceiver,
    /// Receivers of the loop's records.
    pub sinks: Vec<Box<dyn RecordSink>>,
    /// The clock of all threads.
    pub clock: SystemClock,
}

/// The running threads.
#[derive(Debug)]
pub struct Threads {
    /// Signs of life of all threads.
    pub vitals: Arc<Vitals>,
    /// Number of buses.
    pub buses: usize,
    /// Errors that have ended a thread.
    pub errors: std::sync::mpsc::Receiver<ThreadError>,
    must_end: Arc<AtomicBool>,
    handles: Vec<JoinHandle<()>>,
}

/// The error of a thread.
#[derive(Debug, thiserror::Error)]
pub enum ThreadError {
    /// The sensors of a bus cannot be started.
    #[error(transparent)]
    Start(#[from] StartFault),
    /// The neutral value of a whisker cannot be measured.
    #[error(transparent)]
    Zeroing(#[from] ZeroingFault),
    /// A board has an invalid address.
    #[error(transparent)]
    Address(#[from] vibrissa_mlx90393::InvalidAddress),
    /// The sensor does not permit its settings.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The machine has failed.
    #[error("the machine has failed: {0}")]
    Machine(String),
    /// The system starts no thread.
    #[error("the system starts no thread: {0}; end other programs")]
    Spawn(#[from] std::io::Error),
}

/// What every thread has.
#[derive(Clone)]
struct Common {
    clock: SystemClock,
    vitals: Arc<Vitals>,
    must_end: Arc<AtomicBool>,
    errors: std::sync::mpsc::Sender<ThreadError>,
    sample_period_ns: u64,
    /// Time of the sample period with the number 0 (ns).
    origin_ns: u64,
}

impl Common {
    fn goes_on(&self) -> bool {
        !self.must_end.load(Ordering::Acquire)
    }
}

impl<B: Bus + 'static> Robot<B> {
    /// Starts all threads. The machine begins once every whisker has its neutral value and a pose has arrived.
    ///
    /// # Errors
    /// [`ThreadError`] if a thread cannot be started. Errors inside of threads come through [`Threads::errors`].
    pub fn start(self) -> Result<Threads, ThreadError> {
        let checked = self.config.settings()?;
        let (vitals, must_end) = (Arc::new(Vitals::default()), Arc::new(AtomicBool::new(false)));
        let (error_sender, errors) = std::sync::mpsc::channel();
        let common = Common {
            clock: self.clock,
            vitals: Arc::clone(&vitals),
            must_end: Arc::clone(&must_end),
            errors: error_sender,
            sample_period_ns: period_ns(self.config.rig.sensing.sample_rate),
            origin_ns: self.clock.now_ns() + LEAD_NS,
        };
        let mut handles = Vec::new();
        let mut inputs = Vec::new();
        for (index, (open, bus)) in (0_u8..).zip(self.buses.into_iter().zip(&self.config.buses)) {
            let (rounds, consumer) = RingBuffer::new(QUEUE);
            inputs.push(consumer);
            let acquisition = Acquisition::new(index, &bus.boards, checked)?;
            let whiskers = self.config.whiskers_on(usize::from(index));
            let own = common.clone();
            let body = move || acquire(&own, open(), acquisition, &whiskers, rounds);
            handles.push(thread(&common, &format!("bus {index}"), body)?);
        }
        let (pose_sender, poses) = RingBuffer::new(QUEUE);
        let (command_sender, commands) = RingBuffer::new(QUEUE);
        let ([control_records, supervision_records], records) = record_queues();
        let task = ControlTask::new(
            &self.config,
            self.control,
            Assembler::new(&self.config, &checked),
            Inputs { rounds: inputs, poses },
            Outputs { commands: command_sender, records: control_records },
            Arc::clone(&vitals),
        );
        let tick_periods = self.config.rounds_per_tick();
        let own = common.clone();
        handles.push(thread(&common, "control", move || control(&own, task, tick_periods))?);
        let own = common.clone();
        let supervisor = Supervisor::new(&self.config);
        let actuator = self.actuator;
        handles.push(thread(&common, "supervision", move || {
            supervise(&own, supervisor, actuator, commands, supervision_records);
        })?);
        let (own, receive, latency) = (common.clone(), self.poses, self.config.pose.latency);
        handles.push(thread(&common, "pose", move || receive_poses(&own, receive, latency, pose_sender))?);
        let (own, sinks) = (common.clone(), self.sinks);
        handles.push(thread(&common, "telemetry", move || pass_on(&own, records, sinks))?);
        Ok(Threads { vitals, buses: self.config.buses.len(), errors, must_end, handles })
    }
}

impl Threads {
    /// Asks for a stop, as a signal of the system does. The supervisor sends stop commands from now on.
    pub fn terminate(&self) {
        self.vitals.is_terminated.store(true, Ordering::Release);
    }

    /// Ends all threads and waits for them. A thread whose call is blocked is left behind.
    pub fn end(self) {
        self.must_end.store(true, Ordering::Release);
        for handle in self.handles {
            if handle.is_finished() || self.vitals.has_panicked.load(Ordering::Acquire) {
                continue;
            }
            // A panic has been reported by the thread itself.
            let _ = handle.join();
        }
    }
}

thread_local! {
    /// The vitals that learn of a panic of this thread.
    static VITALS: OnceCell<Arc<Vitals>> = const { OnceCell::new() };
}

/// Notes a panic of a thread before it is printed. The backtrace of a large program takes longer than the supervisor may
/// need to stop the robot.
fn note_panics_at_once() {
    static NOTES: Once = Once::new();
    NOTES.call_once(|| {
        let print = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            // A thread that ends has no vitals any more.
            let _ = VITALS.try_with(|vitals| {
                if let Some(vitals) = vitals.get() {
                    vitals.has_panicked.store(true, Ordering::Release);
                }
            });
            print(panic);
        }));
    });
}

/// Starts a thread. A panic in it stops the robot.
fn thread(common: &Common, name: &str, body: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, ThreadError> {
    note_panics_at_once();
    let vitals = Arc::clone(&common.vitals);
    let guarded = move || {
        // The thread is new, so the cell is empty.
        let _ = VITALS.with(|own| own.set(Arc::clone(&vitals)));
        vitals.guard(body);
    };
    Ok(std::thread::Builder::new().name(name.to_owned()).spawn(guarded)?)
}

fn acquire<B: Bus>(
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

fn control(common: &Common, mut task: ControlTask, tick_periods: u64) {
    raise_priority(CONTROL_PRIORITY);
    let period_ns = tick_periods * common.sample_period_ns;
    let offset_ns = tick_offset_ns(common.sample_period_ns);
    let (mut tick, mut has_failed) = (1, false);
    while common.goes_on() {
        let due_ns = common.origin_ns + tick * period_ns + offset_ns;
        let now_ns = common.clock.now_ns();
        let missed = now_ns.saturating_sub(due_ns) / period_ns;
        common.vitals.miss(Phase::Control, missed);
        tick += missed;
        let due_ns = due_ns + missed * period_ns;
        common.clock.sleep_until_ns(due_ns);
        let clock = common.clock;
        match task.step(due_ns, tick * tick_periods, common.origin_ns, || clock.now_ns(), |_, _, _| {}) {
            Ok(_) => {
                tick += 1;
                if let (Some(failure), false) = (task.control().machine().failure(), has_failed) {
                    has_failed = true;
                    let _ = common.errors.send(ThreadError::Machine(failure.to_string()));
                }
            }
            Err(error) => {
                let _ = common.errors.send(error.into());
                return;
            }
        }
    }
}

fn supervise(
    common: &Common,
    mut supervisor: Supervisor,
    mut actuator: Box<dyn Actuator>,
    mut commands: Consumer<StampedCommand>,
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
        let mut command = None;
        while let Ok(newer) = commands.pop() {
            command = Some(newer);
        }
        let now_ns = common.clock.now_ns();
        let acknowledged_ns = actuator.acknowledged_ns(now_ns);
        let mut log = |event| records.send(&LoopRecord::Event(event));
        let packet = supervisor.step(now_ns, &common.vitals, command, acknowledged_ns, &mut log);
        // The missing acknowledgement tells a command that cannot be sent.
        let _ = actuator.send(&packet);
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

fn receive_poses(common: &Common, mut receive: PoseReceiver, latency: f64, mut poses: Producer<StampedPose>) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    let latency_ns = (latency * 1e9) as u64;
    while common.goes_on() {
        let Some(pose) = receive() else { continue };
        let now_ns = common.clock.now_ns();
        if common.vitals.pose_arrived(&pose, now_ns) {
            let _ = poses.push(StampedPose { time_ns: now_ns.saturating_sub(latency_ns), pose });
        }
    }
}

fn pass_on(common: &Common, mut records: Records, mut sinks: Vec<Box<dyn RecordSink>>) {
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
