//! The two services in real time: the sensor IO on emulated buses, and the controller, as two processes.

use std::net::SocketAddr;
use std::process::Stdio;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use rumqttc::PublishOptions;
use vibrissa_robot::link::CommandPacket;
use vibrissa_robot::telemetry::{OFFLINE, ONLINE, Topic};
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::signal::Command;

use crate::gate::Gate;
use crate::listener::Listener;
use crate::mosquitto::Mosquitto;
use crate::robot::{Outside, Running, program};
use crate::server::Server;
use crate::wait_until;

/// The time of silence after which the sensor IO stops the platform: `timeouts: {control: 120 ms}` of the configuration, a
/// period of the supervisor, and much time for a loaded machine.
const STOP: Duration = Duration::from_secs(1);

/// The robot with an actuator and a localisation over UDP, and a broker for both services.
fn robot(name: &str, broker: SocketAddr) -> Outside {
    Outside::with(name, &format!("mqtt: {{host: 127.0.0.1, port: {}}}\n", broker.port()))
}

fn sensor_io(robot: &Outside, server: &Server) -> Running {
    let arguments = ["sensor-io", "--config", &robot.files.config];
    Running(program(server, &arguments).stderr(Stdio::inherit()).spawn().unwrap())
}

fn controller(robot: &Outside, server: &Server) -> Running {
    // The measurement of a loaded machine would refuse the rates.
    let arguments = ["control", &robot.files.machine, "--config", &robot.files.config, "--skip-admission"];
    Running(program(server, &arguments).stderr(Stdio::piped()).spawn().unwrap())
}

fn moves(packet: &CommandPacket) -> bool {
    !packet.is_stop && packet.command.velocity_world.norm() > 0.0
}

#[test]
fn a_controller_that_is_killed_stops_the_platform_and_the_next_one_moves_it_again() {
    let Some(broker) = Mosquitto::start() else { return };
    let (server, listener) = (Server::start(), Listener::of_all(broker.address));
    let robot = robot("killed", broker.address);
    let _sensor_io = sensor_io(&robot, &server);
    robot.wait_for(|packet| packet.is_stop);
    let mut first = controller(&robot, &server);
    let moving = robot.wait_for(moves);
    assert!(moving.command.velocity_world.norm() <= 0.2 + 1e-12, "the limit of the configuration");

    first.kill();
    let before = Instant::now();
    robot.wait_for(|packet| packet.is_stop);
    assert!(before.elapsed() < STOP, "{:?}", before.elapsed());
    let mut second = controller(&robot, &server);
    robot.wait_for(moves);

    // A controller that ends says so by stops, which are forwarded.
    second.terminate();
    robot.wait_for(|packet| packet.is_stop);
    assert!(second.wait().success());
    for topic in ["sensor_io/samples", "sensor_io/health", "state", "perception", "health"] {
        let name = format!("vibrissa/test/{topic}");
        wait_until(&name, || listener.all().iter().any(|arrival| arrival.topic == name));
    }
    assert!(!listener.all().iter().any(|arrival| arrival.topic == Topic::Samples.of("test")));
}

/// A controller that sends a packet every 10 ms, until it is dropped.
struct Sending(Arc<AtomicBool>);

impl Sending {
    /// It has the number and the time (ms) of each packet, by its index and the time (ms) since the start.
    fn start(broker: SocketAddr, packet: impl Fn(u64, u64) -> (u64, u64) + Send + 'static) -> Self {
        let (has_ended, client) = (Arc::<AtomicBool>::default(), Listener::new(broker, "none", |_, _| {}));
        let (own, begin) = (Arc::clone(&has_ended), Instant::now());
        std::thread::spawn(move || {
            for index in (0..).take_while(|_| !own.load(Ordering::Relaxed)) {
                let (sequence, time_ms) = packet(index, u64::try_from(begin.elapsed().as_millis()).unwrap());
                let command = Command { velocity_world: Vector2::new(0.05, 0.0), yaw_rate: 0.0 };
                let packet = CommandPacket { sequence, time_ns: time_ms * 1_000_000, command, is_stop: false };
                client.publish("vibrissa/test/sensor_io/command", &packet.to_bytes(), PublishOptions::at_most_once());
                std::thread::sleep(Duration::from_millis(10));
            }
        });
        Self(has_ended)
    }
}

impl Drop for Sending {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[test]
fn commands_that_are_repeated_or_grow_old_stop_the_platform_and_young_ones_in_order_move_it() {
    let Some(broker) = Mosquitto::start() else { return };
    let server = Server::start();
    let robot = robot("commands", broker.address);
    let _sensor_io = sensor_io(&robot, &server);
    robot.wait_for(|packet| packet.is_stop);
    let stands_still = || {
        robot.wait_for(|packet| packet.is_stop);
        let end = Instant::now() + Duration::from_millis(500);
        robot.wait_for(|packet| {
            assert!(packet.is_stop);
            Instant::now() > end
        });
    };
    let first = Sending::start(broker.address, |index, now_ms| (1000 + index, now_ms));
    robot.wait_for(moves);
    drop(first);
    stands_still();
    let repeated: [fn(u64) -> u64; 3] = [|_| 1, |index| 1 + index % 2, |index| 900_u64.saturating_sub(index)];
    for number in repeated {
        let _sending = Sending::start(broker.address, move |index, now_ms| (number(index), now_ms));
        stands_still();
    }
    // A controller that starts again.
    let second = Sending::start(broker.address, |index, now_ms| (1 + index, now_ms));
    robot.wait_for(moves);
    drop(second);
    stands_still();
    // Packets that are older each time.
    let _late = Sending::start(broker.address, |index, now_ms| (1 + index, now_ms * 9 / 10));
    robot.wait_for(moves);
    stands_still();
}

#[test]
fn a_fault_of_the_sensors_makes_the_machine_wait_and_a_new_sensor_io_needs_a_new_controller() {
    let Some(broker) = Mosquitto::start() else { return };
    let (server, listener) = (Server::start(), Listener::of_all(broker.address));
    let robot = robot("sensors-fail", broker.address);
    let mut first = sensor_io(&robot, &server);
    let mut controller = controller(&robot, &server);
    robot.wait_for(moves);
    robot.pause_poses(true);
    robot.wait_for(|packet| packet.is_stop);
    wait_until("the wait of the machine", || {
        listener.on(Topic::State).last().is_some_and(|state| state.json()["is_paused"] == true)
    });
    robot.pause_poses(false);
    robot.wait_for(moves);

    first.kill();
    wait_until("the fault", || {
        let own = listener.all().into_iter().filter(|arrival| arrival.topic == Topic::Events.of("test"));
        own.map(|event| event.json()).any(|event| event["fault"] == "bus_blocked" && event["change"] == "reacted")
    });
    let _second = sensor_io(&robot, &server);
    assert_eq!(controller.wait().code(), Some(2));
    let mut message = String::new();
    std::io::Read::read_to_string(controller.0.stderr.as_mut().unwrap(), &mut message).unwrap();
    assert!(message.contains("the sensor IO has been started again"), "{message}");
}

#[test]
fn a_broker_that_is_gone_stops_the_platform_and_its_return_moves_it_again() {
    let Some(mut broker) = Mosquitto::start() else { return };
    let (server, gate) = (Server::start(), Gate::before(broker.address));
    let listener = Listener::of_all(broker.address);
    let robot = robot("no-broker", gate.address);
    let mut sensor_io = sensor_io(&robot, &server);
    let mut controller = controller(&robot, &server);
    robot.wait_for(moves);

    broker.kill();
    gate.close();
    let before = Instant::now();
    robot.wait_for(|packet| packet.is_stop);
    assert!(before.elapsed() < STOP, "{:?}", before.elapsed());
    let end = Instant::now() + Duration::from_millis(700);
    robot.wait_for(|packet| {
        assert!(packet.is_stop, "nothing moves the platform without a broker");
        Instant::now() > end
    });
    broker.restart();
    listener.wait_for_subscription(2);
    gate.open();
    robot.wait_for(moves);

    controller.terminate();
    assert!(controller.wait().success());
    sensor_io.terminate();
    assert!(sensor_io.wait().success());
    wait_until("the farewells", || {
        let is = |name: &str, text: &str| {
            let arrivals = listener.on(Topic::Status);
            arrivals.iter().rfind(|arrival| arrival.topic == name).is_some_and(|arrival| arrival.text() == text)
        };
        is("vibrissa/test/status", OFFLINE) && is("vibrissa/test/sensor_io/status", OFFLINE)
    });
    assert!(listener.on(Topic::Status).iter().any(|arrival| arrival.text() == ONLINE));
    let samples = listener.on(Topic::Samples);
    let sequences: std::collections::BTreeSet<u64> =
        samples.iter().filter_map(|arrival| arrival.json()["sequence"].as_u64()).collect();
    assert!(samples.len() > 30 && sequences.len() > 30, "the samples of the outage arrive later");
}
