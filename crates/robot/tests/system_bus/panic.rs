//! The threads of the program, one of which panics.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Once};
use std::time::{Duration, Instant};

use embedded_hal::i2c::{ErrorType, I2c, Operation};
use vibrissa_mlx90393_emulator::{EmulatedBus, EmulatedBusError, EmulatedSensor, SensorOptions};
use vibrissa_robot::array::Bus;
use vibrissa_robot::config::{Config, Timeouts};
use vibrissa_robot::drive::{LoopRecord, RecordSink};
use vibrissa_robot::fault::{FaultChange, FaultEvent, FaultKind};
use vibrissa_robot::link::{Actuator, CommandPacket, LinkError, PosePacket, ReceivedPose};
use vibrissa_robot::program::{PoseReceiver, Robot, SystemClock};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::rig::Rig;

use super::robot::PATIENCE;

/// The supervisor sends this many packets in 100 ms. They are counted, because a loaded machine delays all threads.
const PACKETS: usize = 10;

/// Makes a thread panic at its next call.
#[derive(Clone, Default)]
struct Trigger {
    is_armed: Arc<AtomicBool>,
    has_fired: Arc<AtomicBool>,
}

impl Trigger {
    fn call(&self) {
        if self.is_armed.load(Ordering::SeqCst) {
            self.has_fired.store(true, Ordering::SeqCst);
            panic!("an injected fault");
        }
    }
}

/// A bus with one sensor, in real time.
struct FragileBus {
    bus: EmulatedBus<fn(usize, u64) -> [f64; 3]>,
    clock: SystemClock,
    trigger: Trigger,
}

impl FragileBus {
    fn new(clock: SystemClock, trigger: Trigger) -> Self {
        let mut bus = EmulatedBus::new((|_, _| [0.0; 3]) as fn(usize, u64) -> [f64; 3]);
        bus.add(EmulatedSensor::new(SensorOptions::default()));
        Self { bus, clock, trigger }
    }
}

impl ErrorType for FragileBus {
    type Error = EmulatedBusError;
}

impl I2c for FragileBus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), EmulatedBusError> {
        self.trigger.call();
        self.bus.clock().advance_to_ns(self.clock.now_ns());
        self.bus.transaction(address, operations)
    }
}

impl Bus for FragileBus {
    fn now_ns(&self) -> u64 {
        self.clock.now_ns()
    }

    fn pause_ns(&mut self, duration_ns: u64) {
        self.clock.sleep_until_ns(self.clock.now_ns() + duration_ns);
    }
}

/// A packet, the thread that has sent it, and whether the panic had begun before.
struct Sent {
    packet: CommandPacket,
    thread: String,
    is_after: bool,
}

/// An actuator that reports every packet to the test.
struct Reporter {
    packets: Sender<Sent>,
    trigger: Trigger,
}

impl Actuator for Reporter {
    fn send(&mut self, packet: &CommandPacket) -> Result<(), LinkError> {
        let thread = std::thread::current().name().unwrap_or_default().to_owned();
        let is_after = self.trigger.has_fired.load(Ordering::SeqCst);
        // At the end of the test, nobody receives.
        let _ = self.packets.send(Sent { packet: *packet, thread, is_after });
        Ok(())
    }

    fn acknowledged_ns(&mut self, _: u64) -> Option<u64> {
        None
    }
}

/// A receiver of fault events.
struct Events(Sender<FaultEvent>);

impl RecordSink for Events {
    fn take(&mut self, record: &LoopRecord) {
        if let LoopRecord::Event(event) = record {
            let _ = self.0.send(*event);
        }
    }
}

/// Set before the first robot of the process starts.
static SLOW: Once = Once::new();

/// The report of a panic takes as long as a large backtrace, and longer than the packets that are permitted.
fn print_slowly() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        std::thread::sleep(Duration::from_millis(500));
        print(panic);
    }));
}

/// Starts a robot, and makes a thread of it panic once it moves. `on_bus` and `on_pose` are called on these threads.
fn panics(on_bus: &Trigger, on_pose: &Trigger, trigger: &Trigger) {
    SLOW.call_once(print_slowly);
    let mut config = Config::emulated(Rig::default(), 1.5);
    // No other fault may stop the robot.
    config.timeouts = Timeouts { bus: 1e3, sensor: 1e3, pose: 1e3, control: 1e3, link: 1e3, settle: 1e3 };
    let artifact = Artifact::from_bytes(include_bytes!("../../../runtime/fixtures/bang.machine")).unwrap();
    let control = Control::new(&config.rig, Arc::new(artifact.program)).unwrap();
    let clock = SystemClock::start();
    let bus = |trigger: Trigger| -> Box<dyn FnOnce() -> FragileBus + Send> {
        Box::new(move || FragileBus::new(clock, trigger))
    };
    let buses = vec![bus(on_bus.clone()), bus(Trigger::default())];
    let on_pose = on_pose.clone();
    let mut sequences = 1..;
    let poses: PoseReceiver = Box::new(move || {
        std::thread::sleep(Duration::from_millis(5));
        on_pose.call();
        let packet = PosePacket { sequence: sequences.next()?, pose: Pose::default() };
        Some(ReceivedPose::Packet(packet))
    });
    let (packet_sender, packets) = channel();
    let (event_sender, events) = channel();
    let actuator = Box::new(Reporter { packets: packet_sender, trigger: trigger.clone() });
    let sinks: Vec<Box<dyn RecordSink>> = vec![Box::new(Events(event_sender))];
    let threads = Robot { config, control, buses, actuator, poses, sinks, clock }.start().unwrap();
    wait_for(&packets, |sent: &Sent| !sent.packet.is_stop && sent.packet.command.velocity_world.norm() > 0.0);
    trigger.is_armed.store(true, Ordering::SeqCst);
    let mut moving = 0;
    let stop = wait_for(&packets, |sent: &Sent| {
        moving += usize::from(sent.is_after && !sent.packet.is_stop);
        sent.packet.is_stop || moving > PACKETS
    });
    assert!(stop.packet.is_stop && stop.is_after, "{moving} packets after the panic still move the robot");
    assert_eq!(stop.thread, "supervision");
    let is_reaction = |event: &FaultEvent| event.change == FaultChange::Reacted;
    assert_eq!(wait_for(&events, is_reaction).fault.kind, FaultKind::Panic);
    threads.end();
}

/// The next message that is as `wanted`.
fn wait_for<T>(messages: &Receiver<T>, mut wanted: impl FnMut(&T) -> bool) -> T {
    let before = Instant::now();
    loop {
        let message = messages.recv_timeout(PATIENCE).unwrap();
        if wanted(&message) {
            return message;
        }
        assert!(before.elapsed() < PATIENCE, "no such message");
    }
}

#[test]
fn a_bus_that_panics_stops_the_robot_from_another_thread() {
    let trigger = Trigger::default();
    panics(&trigger, &Trigger::default(), &trigger);
}

#[test]
fn a_receiver_of_poses_that_panics_stops_the_robot_from_another_thread() {
    let trigger = Trigger::default();
    panics(&Trigger::default(), &trigger, &trigger);
}
