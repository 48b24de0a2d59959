//! The threads of the loop.

use std::cell::OnceCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Once};
use std::thread::JoinHandle;
use vibrissa_text::system::in_words;

use rtrb::{Consumer, RingBuffer};
use vibrissa_runtime::control::Control;

use super::system_clock::SystemClock;
use super::thread_bodies::{acquire, control, pass_on, receive_poses, supervise};
use crate::array::{Acquisition, Assembler, Bus, Round, StartFault, ZeroingFault, period_ns};
use crate::config::{Config, ConfigError};
use crate::drive::{ControlTask, Inputs, Outputs, QUEUE, RecordSink, Supervisor, record_queues};
use crate::link::{Actuator, PoseGate, ReceivedPose};
use crate::sensor::Refused;
use crate::services::InputsError;
use crate::vitals::Vitals;

/// Time (ns) from the start of the threads to the first round, so that all threads are ready.
const LEAD_NS: u64 = 20_000_000;

/// Opens a bus, on the thread that reads it.
pub type OpenBus<B> = Box<dyn FnOnce() -> B + Send>;

/// A source of poses. It waits for at most some milliseconds.
pub type PoseReceiver = Box<dyn FnMut() -> Option<ReceivedPose> + Send>;

/// Everything that the threads need.
pub struct Robot<B> {
    /// The configuration.
    pub config: Config,
    /// The control loop.
    pub control: Control,
    /// One opener for each bus. It runs on the thread of the bus.
    pub buses: Vec<OpenBus<B>>,
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
    /// Number of buses that the threads read.
    pub buses: usize,
    /// True if the control task runs by itself. In the controller it waits for inputs, and the sensor IO has none.
    pub has_own_ticks: bool,
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
    Address(#[from] Refused),
    /// The sensor does not permit its settings.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The controller cannot use the inputs of the sensor IO.
    #[error(transparent)]
    Inputs(#[from] InputsError),
    /// The connection to the broker cannot begin.
    #[error(transparent)]
    Broker(#[from] crate::mqtt::StartError),
    /// The machine has failed.
    #[error("the machine has failed: {0}")]
    Machine(String),
    /// The system starts no thread.
    #[error("the system starts no thread: {words}; end other programs", words = in_words(.0))]
    Spawn(#[from] std::io::Error),
}

/// The threads of the acquisitions, and the rounds of each bus.
type Acquisitions = (Vec<JoinHandle<()>>, Vec<Consumer<Round>>);

/// What every thread has.
#[derive(Clone)]
pub(super) struct Common {
    pub(super) clock: SystemClock,
    pub(super) vitals: Arc<Vitals>,
    must_end: Arc<AtomicBool>,
    pub(super) errors: std::sync::mpsc::Sender<ThreadError>,
    pub(super) sample_period_ns: u64,
    /// Time of the sample period with the number 0 (ns).
    pub(super) origin_ns: u64,
}

impl Common {
    /// What the threads of a program with this configuration have, and the errors that end them.
    pub(super) fn new(config: &Config, clock: SystemClock) -> (Self, std::sync::mpsc::Receiver<ThreadError>) {
        let (sender, errors) = std::sync::mpsc::channel();
        let common = Self {
            clock,
            vitals: Arc::default(),
            must_end: Arc::default(),
            errors: sender,
            sample_period_ns: period_ns(config.rig.sensing.sample_rate),
            origin_ns: clock.now_ns() + LEAD_NS,
        };
        (common, errors)
    }

    pub(super) fn goes_on(&self) -> bool {
        !self.must_end.load(Ordering::Acquire)
    }

    /// Starts a thread. A panic in it stops the robot.
    pub(super) fn spawn(
        &self,
        name: &str,
        body: impl FnOnce(&Self) + Send + 'static,
    ) -> Result<JoinHandle<()>, ThreadError> {
        note_panics_at_once();
        let own = self.clone();
        let guarded = move || {
            // The thread is new, so the cell is empty.
            let _ = VITALS.with(|vitals| vitals.set(Arc::clone(&own.vitals)));
            own.vitals.guard(|| body(&own));
        };
        Ok(std::thread::Builder::new().name(name.to_owned()).spawn(guarded)?)
    }

    /// Starts the acquisition of every bus.
    pub(super) fn acquisitions<B: Bus + 'static>(
        &self,
        config: &Config,
        buses: Vec<OpenBus<B>>,
    ) -> Result<Acquisitions, ThreadError> {
        let sensor = config.sensor()?;
        let (mut handles, mut inputs) = (Vec::new(), Vec::new());
        for (index, (open, bus)) in (0_u8..).zip(buses.into_iter().zip(&config.buses)) {
            let (rounds, consumer) = RingBuffer::new(QUEUE);
            inputs.push(consumer);
            let acquisition = Acquisition::new(index, &bus.boards, &sensor)?;
            let whiskers = config.whiskers_on(usize::from(index));
            let body = move |common: &Self| acquire(common, open(), acquisition, &whiskers, rounds);
            handles.push(self.spawn(&format!("bus {index}"), body)?);
        }
        Ok((handles, inputs))
    }

    /// The running threads.
    pub(super) fn running(
        self,
        errors: std::sync::mpsc::Receiver<ThreadError>,
        handles: Vec<JoinHandle<()>>,
        buses: usize,
        has_own_ticks: bool,
    ) -> Threads {
        Threads { vitals: self.vitals, buses, has_own_ticks, errors, must_end: self.must_end, handles }
    }
}

impl<B: Bus + 'static> Robot<B> {
    /// Starts all threads. The machine begins once every whisker has its neutral value and a pose has arrived.
    ///
    /// # Errors
    /// [`ThreadError`] if a thread cannot be started. Errors inside of threads come through [`Threads::errors`].
    pub fn start(self) -> Result<Threads, ThreadError> {
        let sensor = self.config.sensor()?;
        let (common, errors) = Common::new(&self.config, self.clock);
        let (mut handles, rounds) = common.acquisitions(&self.config, self.buses)?;
        let (pose_sender, poses) = RingBuffer::new(QUEUE);
        let (command_sender, commands) = RingBuffer::new(QUEUE);
        let ([control_records, supervision_records], records) = record_queues();
        let task = ControlTask::new(
            &self.config,
            self.control,
            Assembler::new(&self.config, &sensor),
            Inputs { rounds, poses },
            Outputs { commands: command_sender, records: control_records },
            Arc::clone(&common.vitals),
        );
        let tick_periods = self.config.rounds_per_tick();
        handles.push(common.spawn("control", move |common| control(common, task, tick_periods))?);
        let (supervisor, actuator) = (Supervisor::new(&self.config), self.actuator);
        handles.push(common.spawn("supervision", move |common| {
            supervise(common, supervisor, actuator, commands, supervision_records);
        })?);
        let (receive, gate, latency) = (self.poses, PoseGate::new(&self.config), self.config.pose.latency);
        handles.push(common.spawn("pose", move |common| receive_poses(common, receive, gate, latency, pose_sender))?);
        let sinks = self.sinks;
        handles.push(common.spawn("telemetry", move |common| pass_on(common, records, sinks))?);
        Ok(common.running(errors, handles, self.config.buses.len(), true))
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
