//! The messages of an undisturbed connection.

use std::collections::BTreeSet;

use serde::Serialize;
use serde::de::DeserializeOwned;
use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::fault::{FaultChange, FaultKind};
use vibrissa_robot::telemetry::{
    CommandLog, FaultNote, Health, Latency, Motion, Numbered, OFFLINE, ONLINE, Perception, Samples, State, Topic,
};
use vibrissa_runtime::rig::Rig;

use crate::emulated::EmulatedRobot;
use crate::listener::{Arrival, Listener};
use crate::mosquitto::{Mosquitto, free_port};
use crate::wait_until;

/// Reads messages as a payload that has all of their keys.
fn read<T: DeserializeOwned + Serialize>(arrivals: &[Arrival]) -> Vec<Numbered<T>> {
    let read = |arrival: &Arrival| {
        let message: Numbered<T> = serde_json::from_slice(&arrival.payload).unwrap();
        assert_eq!(keys(&serde_json::to_value(&message).unwrap()), keys(&arrival.json()), "{}", arrival.topic);
        message
    };
    arrivals.iter().map(read).collect()
}

/// The paths of all keys.
fn keys(value: &serde_json::Value) -> BTreeSet<String> {
    let below = |name: &str, value| keys(value).into_iter().map(|key| format!("{name}.{key}")).collect::<Vec<_>>();
    match value {
        serde_json::Value::Object(map) => {
            map.iter().flat_map(|(name, value)| [name.clone()].into_iter().chain(below(name, value))).collect()
        }
        serde_json::Value::Array(list) => list.iter().flat_map(|value| below("[]", value)).collect(),
        _ => BTreeSet::new(),
    }
}

fn contents<T: DeserializeOwned + Serialize>(listener: &Listener, topic: Topic) -> Vec<T> {
    let messages = read(&listener.on(topic));
    assert!(messages.iter().is_sorted_by_key(|message| message.sequence), "{topic:?}");
    messages.into_iter().map(|message| message.content).collect()
}

#[test]
fn every_topic_arrives_and_says_what_the_robot_does() {
    let Some(broker) = Mosquitto::start() else { return };
    let listener = Listener::of_all(broker.address);
    let no_pose = Injection { at_ms: 3000, for_ms: 1500, kind: InjectionKind::NoPose, part: 0 };
    let settings = Settings { injections: vec![no_pose], ..Settings::default() };
    let mut robot = EmulatedRobot::with_telemetry(&settings, broker.address, 100_000);
    robot.run(12_000);
    listener.wait_for_status(ONLINE);
    wait_until("the transmission", || robot.counts().0 == 0);
    robot.finish();
    listener.wait_for_status(OFFLINE);

    let samples: Vec<Samples> = contents(&listener, Topic::Samples);
    check_samples(&samples);
    let perception: Vec<Perception> = contents(&listener, Topic::Perception);
    assert_eq!(perception.len(), robot.commands.len(), "one per tick of the machine");
    let travelled = |tick: &Perception| tick.pose.map_or(0.0, |pose| pose.position_m[0].hypot(pose.position_m[1]));
    assert!(perception.iter().any(|tick| travelled(tick) > 0.01));
    assert!(perception.iter().any(|tick| tick.whiskers.iter().any(|whisker| whisker.tip_m.is_some())));
    let commands: Vec<CommandLog> = contents(&listener, Topic::CommandLog);
    check_commands(&commands, &robot.commands);
    let states: Vec<State> = contents(&listener, Topic::State);
    assert!(states.iter().all(|state| state.policy == "bang" && !state.has_failed));
    let names: BTreeSet<_> = states.iter().filter_map(|state| state.state.as_deref()).collect();
    assert!(names.len() > 1, "{names:?}");
    assert!(states.iter().any(|state| state.is_paused) && states.last().is_some_and(|state| !state.is_paused));
    let notes: Vec<FaultNote> = contents(&listener, Topic::Events);
    let changes: Vec<_> =
        notes.iter().filter(|note| note.fault.fault == FaultKind::PoseOld).map(|note| note.change).collect();
    assert_eq!(changes, [FaultChange::Detected, FaultChange::Reacted, FaultChange::Recovered]);
    let health: Vec<Health> = contents(&listener, Topic::Health);
    assert_eq!(health.len(), 12, "one per second");
    let has_fault = |health: &Health| health.faults.iter().any(|fault| fault.fault == FaultKind::PoseOld);
    assert!(health.iter().any(has_fault) && !health.last().is_some_and(has_fault));
    assert!(health.iter().all(|health| (health.lost_records, health.dropped_messages) == (0, 0)));
    let latency: Vec<Latency> = contents(&listener, Topic::Latency);
    let age = &latency.last().unwrap().sample_age;
    assert!(age.count > 200 && age.largest_s < 0.005 && age.counts.iter().sum::<u64>() == age.count, "{age:?}");

    let sequences: Vec<u64> = listener.all().iter().filter_map(sequence).collect();
    assert_eq!(sequences, (1..=sequences.len() as u64).collect::<Vec<_>>(), "complete and in order");
}

/// The number of a message that has one.
pub(crate) fn sequence(arrival: &Arrival) -> Option<u64> {
    if arrival.is_of(Topic::Status) { None } else { arrival.json()["sequence"].as_u64() }
}

/// Compares samples with the motion of the plant, which sways the whiskers by moments of up to 200 µN m.
fn check_samples(samples: &[Samples]) {
    let stiffness = Rig::default().whiskers[0].hinge.stiffness;
    for bus in 0..2 {
        let of_bus = || samples.iter().map(move |message| &message.buses[bus]);
        let times: Vec<f64> = of_bus().flat_map(|bus| bus.time_s.clone()).collect();
        assert!(times.is_sorted() && times.len() > 3500, "{} rounds in 12 s", times.len());
        let angles: Vec<Option<f64>> = of_bus().flat_map(|bus| bus.whiskers[0].base_angle_rad.clone()).collect();
        let fields: Vec<Option<f64>> = of_bus().flat_map(|bus| bus.whiskers[0].field_t.clone()).collect();
        assert_eq!((angles.len(), fields.len()), (times.len(), times.len()));
        // The first second goes to the neutral values.
        assert!(
            angles[..290].iter().all(Option::is_none) && angles[400..].iter().filter(|a| a.is_some()).count() > 2900
        );
        let largest = angles.iter().flatten().fold(0.0_f64, |largest, angle| largest.max(angle.abs()));
        assert!((largest * stiffness / 200e-6 - 1.0).abs() < 0.05, "{largest} rad");
        // The field of a moment is 4.38 µT per µN m.
        let ends = fields.iter().flatten().fold((f64::MAX, f64::MIN), |(low, high), &b| (low.min(b), high.max(b)));
        assert!(((ends.1 - ends.0) / (2.0 * 200e-6 * 4.38) - 1.0).abs() < 0.05, "{ends:?} T");
    }
}

fn check_commands(log: &[CommandLog], commands: &[[u64; 3]]) {
    let packets: Vec<_> = log.iter().flat_map(|message| message.packets.clone()).collect();
    assert!(packets.iter().map(|packet| packet.packet).eq(1..=packets.len() as u64));
    assert!(packets.iter().any(|packet| packet.is_stop) && packets.iter().any(|packet| !packet.is_stop));
    let logged: Vec<Motion> = log.iter().filter_map(|message| message.machine).collect();
    assert_eq!(logged.len(), commands.len());
    for (logged, command) in logged.iter().zip(commands) {
        let [x, y] = logged.velocity_m_per_s;
        for (read, bits) in [x, y, logged.yaw_rate_rad_per_s].into_iter().zip(command) {
            // The reader of the test rounds in the last digit.
            assert!((read - f64::from_bits(*bits)).abs() <= 1e-15, "{read}");
        }
    }
}

#[test]
fn later_subscribers_get_status_state_and_health() {
    let Some(broker) = Mosquitto::start() else { return };
    let mut robot = EmulatedRobot::with_telemetry(&Settings::default(), broker.address, 1000);
    robot.run(3000);
    wait_until("the transmission", || robot.counts().0 == 0);
    robot.finish();
    let listener = Listener::of_all(broker.address);
    listener.wait_for_status(OFFLINE);
    wait_until("all retained messages", || listener.all().len() == 3);
    for topic in Topic::ALL {
        assert_eq!(listener.on(topic).iter().filter(|arrival| arrival.is_retained).count() == 1, topic.is_retained());
    }
    let states: Vec<State> = contents(&listener, Topic::State);
    assert!(states[0].state.is_some());
}

#[test]
fn commands_have_the_same_bits_with_and_without_telemetry() {
    let Some(broker) = Mosquitto::start() else { return };
    let commands = |mut robot: EmulatedRobot| {
        robot.run(6000);
        robot.commands
    };
    let settings = Settings { seed: 5, ..Settings::default() };
    let without = commands(EmulatedRobot::new(&settings));
    assert!(without.len() > 140 && without.iter().any(|command| *command != without[0]));
    // With a broker, with a buffer that overflows, and without a broker.
    assert!(commands(EmulatedRobot::with_telemetry(&settings, broker.address, 10_000)) == without);
    assert!(commands(EmulatedRobot::with_telemetry(&settings, broker.address, 1)) == without);
    assert!(commands(EmulatedRobot::with_telemetry(&settings, free_port(), 100)) == without);
}
