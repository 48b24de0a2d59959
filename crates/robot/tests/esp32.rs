//! The example of sensor IO on a microcontroller: the controller of the robot reads its messages. The sensors are emulated.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../../../examples/esp32/commands.rs"]
#[allow(unreachable_pub, reason = "a program of a microcontroller uses the file as a module of its own")]
mod commands;
#[path = "../../../examples/esp32/sensor_io.rs"]
#[allow(unreachable_pub, reason = "a program of a microcontroller uses the file as a module of its own")]
mod sensor_io;

use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use commands::{Commands, Motion};
use proptest::prelude::*;
use rtrb::RingBuffer;
use sensor_io::{MESSAGE_BYTES, SensorIo};
use vibrissa_mlx90393::{Address, Settings};
use vibrissa_mlx90393_emulator::{EmulatedBus, EmulatedSensor, SensorFault, SensorOptions};
use vibrissa_robot::array::{ReadingState, Round, StampedPose};
use vibrissa_robot::config::Config;
use vibrissa_robot::drive::StepTime;
use vibrissa_robot::link::{CommandGate, CommandPacket, CommandVerdict};
use vibrissa_robot::services::InputReader;
use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::signal::Command;

const ADDRESSES: [u8; 3] = [0x0C, 0x0D, 0x0E];
const CONFIG: &str = "
name: esp32
rig:
  whiskers:
    r0: {base: [25 mm, -12 mm], direction: -105 deg}
    r1: {base: [5 mm, -18 mm], direction: -105 deg}
    r2: {base: [-15 mm, -24 mm], direction: -105 deg}
buses:
  - device: /dev/i2c-1
    clock: 360 kHz
    boards: [{whisker: r0, address: 0x0C}, {whisker: r1, address: 0x0D}, {whisker: r2, address: 0x0E}]
sensor: {gain: 7, resolution: 0, oversampling: 2, filter: 3}
limits: {speed: 0.1 m/s, yaw_rate: 60 deg/s, base_angle: 1050 urad}
actuator: dry_run
pose: {udp: {listen: '127.0.0.1:9751'}, latency: 0 ms, noise: 20 mm, heading_noise: 5 deg}
";

/// What the controller has taken from the messages of some control periods.
struct Taken {
    rounds: Vec<Round>,
    poses: Vec<StampedPose>,
    steps: Vec<StepTime>,
    messages: Vec<String>,
}

/// A pose of the localisation.
fn pose(number: u64, x: f64, heading: f64) -> Vec<u8> {
    let words = [number, x.to_bits(), (-0.5_f64).to_bits(), heading.to_bits()];
    b"VBP1".iter().copied().chain(words.into_iter().flat_map(u64::to_le_bytes)).collect()
}

/// Runs the sensor IO for `periods` control periods. `fault` happens at a sensor at the end of the second one.
fn run(periods: usize, fault: Option<(u8, SensorFault)>) -> Taken {
    let config = Config::from_text(CONFIG).unwrap();
    let (rounds, mut taken_rounds) = RingBuffer::new(64 * periods);
    let (poses, mut taken_poses) = RingBuffer::new(64 * periods);
    let (steps, taken_steps) = sync_channel(64 * periods);
    let mut reader = InputReader::new(&config, vec![rounds], poses, steps, Arc::default()).unwrap();

    // 10 µT at the first sensor, and 10 µT more at each further one.
    let mut bus = EmulatedBus::new(|sensor: usize, _: u64| [0.0, 10.0 * (sensor + 1) as f64, 0.0]);
    for (field_index, address) in ADDRESSES.into_iter().enumerate() {
        bus.add(EmulatedSensor::new(SensorOptions { address, field_index, ..SensorOptions::default() }));
    }
    let clock = bus.clock();
    let addresses = ADDRESSES.map(|address| Address::new(address).unwrap());
    let mut sensor_io = SensorIo::new(addresses, Settings::array().check().unwrap(), 7, 20_000_000);
    let mut buffer = [0; MESSAGE_BYTES];
    let mut messages = Vec::new();
    while messages.len() < periods {
        clock.advance_to_ns(sensor_io.due_ns());
        let number = sensor_io.due_ns();
        sensor_io.pose(&pose(number, 0.25, 1.25), clock.now_ns());
        sensor_io.pose(&pose(number, 9.0, 9.0), clock.now_ns());
        sensor_io.round(&mut bus, &mut clock.clone(), || clock.now_ns());
        if let Some(message) = sensor_io.message(clock.now_ns(), &mut buffer) {
            reader.take(message.as_bytes(), 77_000_000_000 + clock.now_ns()).unwrap();
            messages.push(message.to_owned());
            if let (Some((address, fault)), 2) = (fault, messages.len()) {
                bus.inject_at(address, fault).unwrap();
            }
        }
    }
    Taken {
        rounds: std::iter::from_fn(|| taken_rounds.pop().ok()).collect(),
        poses: std::iter::from_fn(|| taken_poses.pop().ok()).collect(),
        steps: taken_steps.try_iter().collect(),
        messages,
    }
}

#[test]
fn the_controller_reads_rounds_and_poses_of_a_microcontroller() {
    let Taken { rounds, poses, steps, messages } = run(5, None);
    assert_eq!(steps.iter().map(|step| step.last_slot).collect::<Vec<_>>(), [9, 19, 29, 39, 49]);
    let longest = messages.iter().map(String::len).max().unwrap();
    assert!(longest < MESSAGE_BYTES * 3 / 4, "{longest} bytes");
    // Counts are 0.15 µT. The sensors start in the first round, and their first values come with the second or third one.
    for round in rounds.iter().skip(10) {
        let counts = round.readings.iter().take(3).map(|reading| reading.state.counts());
        for (sensor, counts) in counts.enumerate() {
            if let Some(counts) = counts {
                let expected = (sensor + 1) as f64 * 10.0 / 0.15;
                assert!((f64::from(counts) - expected).abs() < 40.0, "{counts} instead of {expected}");
            }
        }
    }
    let fresh =
        |round: &Round| round.readings.iter().take(3).filter(|reading| reading.state.counts().is_some()).count();
    assert!(rounds.iter().skip(10).map(fresh).sum::<usize>() > 100, "almost every reading is new");
    let slots: Vec<_> = rounds.iter().map(|round| round.slot).collect();
    assert!(slots.windows(2).all(|pair| pair[1] > pair[0]), "{slots:?}");
    assert!(rounds.iter().all(|round| round.ended_ns > round.started_ns && round.count == 3));
    // The second packet of each pair has the number of the first.
    let pose = Pose { position: Point2::new(0.25, -0.5), heading: 1.25 };
    assert!(poses.iter().all(|stamped| stamped.pose == pose));
    assert!(poses.len() > 30, "{}", poses.len());
}

#[test]
fn a_sensor_that_was_reset_is_started_again_and_the_others_are_read_meanwhile() {
    let Taken { rounds, .. } = run(6, Some((0x0D, SensorFault::BrownOut)));
    let of =
        |board: usize| rounds.iter().filter(|round| round.slot >= 20).map(move |round| round.readings[board].state);
    assert!(of(1).any(|state| state == ReadingState::Lost));
    let fresh = |board: usize| of(board).filter(|state| state.counts().is_some()).count();
    assert!(fresh(1) > 20 && fresh(0) > 25, "{} and {}", fresh(1), fresh(0));
}

#[test]
fn poses_that_are_no_packets_or_out_of_order_are_ignored() {
    let mut sensor_io = SensorIo::<3>::new(
        ADDRESSES.map(|address| Address::new(address).unwrap()),
        Settings::array().check().unwrap(),
        7,
        0,
    );
    let mut bus = EmulatedBus::new(|_: usize, _: u64| [0.0; 3]);
    for address in ADDRESSES {
        bus.add(EmulatedSensor::new(SensorOptions { address, ..SensorOptions::default() }));
    }
    for packet in [pose(5, 1.0, 0.0), pose(4, 2.0, 0.0), pose(6, f64::NAN, 0.0), pose(6, 3.0, 0.0)] {
        sensor_io.pose(&packet, 1);
    }
    sensor_io.pose(&pose(7, 4.0, 0.0)[..35], 1);
    sensor_io.pose(&[b"VBX1", &pose(8, 5.0, 0.0)[4..]].concat(), 1);
    let clock = bus.clock();
    let mut buffer = [0; MESSAGE_BYTES];
    let message = loop {
        clock.advance_to_ns(sensor_io.due_ns());
        sensor_io.round(&mut bus, &mut clock.clone(), || clock.now_ns());
        if let Some(message) = sensor_io.message(clock.now_ns(), &mut buffer) {
            break message;
        }
    };
    let message: serde_json::Value = serde_json::from_str(message).unwrap();
    let places: Vec<_> = message["poses"].as_array().unwrap().iter().map(|pose| pose["x"].as_f64()).collect();
    assert_eq!(places, [Some(1.0), Some(3.0)]);
}

const MS: u64 = 1_000_000;

/// A command to drive along x.
fn command(sequence: u64, sent_ms: u64, is_stop: bool) -> CommandPacket {
    let command = Command { velocity_world: Vector2::new(0.05, 0.0), yaw_rate: 0.1 };
    CommandPacket { sequence, time_ns: sent_ms * MS, command, is_stop }
}

proptest! {
    #[test]
    fn a_microcontroller_executes_the_packets_that_the_robots_own_sensor_io_executes(
        packets in prop::collection::vec((0_u64..40, 0_u64..120, 0_u64..30, prop::bool::weighted(0.1)), 1..200),
    ) {
        let (mut commands, mut gate) = (Commands::new(), CommandGate::new(70 * MS));
        let mut now_ms = 5000;
        for (sequence, delay_ms, pause_ms, is_stop) in packets {
            now_ms += pause_ms;
            let packet = command(sequence, now_ms - 4000 - delay_ms, is_stop);
            let taken = commands.take(&packet.to_bytes(), now_ms * MS);
            let is_executed = matches!(gate.take(&packet, now_ms * MS), CommandVerdict::Taken { .. });
            prop_assert_eq!(taken, is_executed.then(|| packet.acknowledgement()));
        }
    }

    #[test]
    fn bytes_that_are_no_command_are_not_executed(bytes: Vec<u8>) {
        prop_assert_eq!(Commands::new().take(&bytes, 0), None);
    }
}

#[test]
fn a_motion_ends_with_the_time_in_its_packet() {
    let mut commands = Commands::new();
    assert_eq!(commands.motion(0), Motion::STOP);
    commands.take(&command(1, 0, false).to_bytes(), 5000 * MS).unwrap();
    assert_eq!(commands.motion(5099 * MS), Motion { x: 0.05, y: 0.0, yaw_rate: 0.1 });
    assert_eq!(commands.motion(5100 * MS), Motion::STOP);
    // It arrives 30 ms late, so that it ends 100 ms after it was to arrive.
    commands.take(&command(2, 10, false).to_bytes(), 5040 * MS).unwrap();
    assert_ne!(commands.motion(5109 * MS), Motion::STOP);
    assert_eq!(commands.motion(5110 * MS), Motion::STOP);
    commands.take(&command(3, 40, true).to_bytes(), 5041 * MS).unwrap();
    assert_eq!(commands.motion(5042 * MS), Motion::STOP);
}
