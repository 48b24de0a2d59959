//! A broker that is killed and started again while the robot runs.

use std::collections::BTreeSet;
use std::net::TcpListener;

use vibrissa_robot::emulation::Settings;
use vibrissa_robot::telemetry::{OFFLINE, ONLINE, Topic};

use crate::emulated::EmulatedRobot;
use crate::gate::Gate;
use crate::listener::{Arrival, Listener};
use crate::mosquitto::Mosquitto;
use crate::topics::sequence;
use crate::wait_until;

/// Runs a robot over two outages of the broker. The result has all messages that have arrived, and the number of those that
/// the telemetry has dropped. `None` without Mosquitto.
fn outages(buffer: usize) -> Option<(Vec<Arrival>, u64)> {
    let mut broker = Mosquitto::start()?;
    // A subscriber without a session misses what is published before it is back. So the robot waits for it.
    let (gate, listener) = (Gate::before(broker.address), Listener::of_all(broker.address));
    let mut robot = EmulatedRobot::with_telemetry(&Settings::default(), gate.address, buffer);
    listener.wait_for_status(ONLINE);
    for outage in 1..=2_u8 {
        robot.run(2000);
        // Messages are on their path now.
        broker.kill();
        gate.close();
        robot.run_until_broker_is(true);
        robot.run(4000);
        broker.restart();
        listener.wait_for_subscription(1 + u32::from(outage));
        gate.open();
        robot.run_until_broker_is(false);
        // The broker died without a last will, so every status is that of a new connection.
        wait_until("the next status", || listener.on(Topic::Status).len() == 1 + usize::from(outage));
        listener.wait_for_status(ONLINE);
    }
    robot.run(1000);
    wait_until("the transmission", || robot.counts().0 == 0);
    let (_, dropped) = robot.counts();
    robot.finish();
    listener.wait_for_status(OFFLINE);
    Some((listener.all(), dropped))
}

/// The numbers of all messages, each once, in the order of their first arrival.
fn distinct(arrivals: &[Arrival]) -> Vec<u64> {
    let mut seen = BTreeSet::new();
    arrivals.iter().filter_map(sequence).filter(|&sequence| seen.insert(sequence)).collect()
}

#[test]
fn nothing_that_fits_the_buffer_is_lost_when_the_broker_is_killed() {
    let Some((arrivals, dropped)) = outages(20_000) else { return };
    let sequences = distinct(&arrivals);
    assert_eq!(dropped, 0);
    assert!(sequences.len() > 1000, "{}", sequences.len());
    let gaps: Vec<_> = sequences.windows(2).filter(|pair| pair[1] != pair[0] + 1).collect();
    assert!(gaps.is_empty() && sequences[0] == 1, "complete and in order, but for {gaps:?}");
    assert!(!arrivals.iter().any(|arrival| arrival.is_of(Topic::Dropped)));
}

#[test]
fn what_does_not_fit_the_buffer_is_counted_exactly() {
    let Some((arrivals, dropped)) = outages(200) else { return };
    let sequences = distinct(&arrivals);
    assert!(dropped > 200, "{dropped}");
    assert!(sequences.is_sorted());
    assert_eq!(sequences.len() as u64 + dropped, *sequences.last().unwrap(), "each message arrives or is counted");
    let reports: Vec<u64> = arrivals.iter().filter_map(report).collect();
    assert_eq!(reports.last(), Some(&dropped));
    let health = arrivals.iter().rfind(|arrival| arrival.is_of(Topic::Health)).unwrap().json();
    assert!(health["dropped_messages"].as_u64().is_some_and(|count| 0 < count && count <= dropped), "{health}");
    // Each report stands where the messages are missing.
    let (mut missing, mut last) = (0, 0);
    for arrival in &arrivals {
        if let Some(report) = report(arrival) {
            missing = report;
        } else if let Some(sequence) = sequence(arrival)
            && sequence > last
        {
            let position = sequences.binary_search(&sequence).unwrap() as u64;
            assert_eq!(sequence - 1 - position, missing);
            last = sequence;
        }
    }
}

/// The number of dropped messages in a report.
fn report(arrival: &Arrival) -> Option<u64> {
    arrival.is_of(Topic::Dropped).then(|| arrival.json()["dropped_messages"].as_u64().unwrap())
}

#[test]
fn a_broker_that_starts_after_the_robot_gets_everything_from_the_start() {
    let Some(mut broker) = Mosquitto::start() else { return };
    let gate = Gate::before(broker.address);
    gate.close();
    broker.kill();
    let mut robot = EmulatedRobot::with_telemetry(&Settings::default(), gate.address, 20_000);
    robot.run_until_broker_is(true);
    robot.run(2000);
    broker.restart();
    let listener = Listener::of_all(broker.address);
    gate.open();
    robot.run_until_broker_is(false);
    wait_until("the transmission", || robot.counts().0 == 0);
    robot.finish();
    listener.wait_for_status(OFFLINE);
    let events = listener.on(Topic::Events);
    let changes: Vec<_> =
        events.iter().map(|event| (event.json()["fault"].clone(), event.json()["change"].clone())).collect();
    assert_eq!(changes[0], ("broker_gone".into(), "detected".into()));
    let sequences = distinct(&listener.all());
    assert!(sequences.iter().copied().eq(1..=sequences.len() as u64) && sequences.len() > 100);
}

#[test]
fn a_broker_that_never_answers_is_gone_and_delays_nothing() {
    // It accepts connections and is silent.
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    let mut robot = EmulatedRobot::with_telemetry(&Settings::default(), silent.local_addr().unwrap(), 500);
    robot.run_until_broker_is(true);
    robot.run(10_000);
    let (waiting, dropped) = robot.counts();
    assert!(waiting == 500 && dropped > 300, "{waiting} {dropped}");
}

#[test]
fn a_broker_that_hangs_is_gone_and_delays_nothing() {
    let Some(broker) = Mosquitto::start() else { return };
    let listener = Listener::of_all(broker.address);
    let mut robot = EmulatedRobot::with_telemetry(&Settings::default(), broker.address, 500);
    listener.wait_for_status(ONLINE);
    broker.hang();
    robot.run(10_000);
    let (waiting, dropped) = robot.counts();
    assert!(waiting >= 500 && dropped > 200, "{waiting} {dropped}");
    robot.run_until_broker_is(true);
}
