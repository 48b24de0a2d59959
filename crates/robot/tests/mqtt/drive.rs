//! The program of the robot in real time, with an actuator and a localisation behind the broker.

use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use rumqttc::PublishOptions;
use vibrissa_robot::link::{CommandPacket, PosePacket};
use vibrissa_robot::telemetry::{OFFLINE, ONLINE, Topic};
use vibrissa_runtime::geometry::{Point2, Pose};

use crate::gate::Gate;
use crate::listener::{Arrival, Listener};
use crate::mosquitto::Mosquitto;
use crate::robot::{Files, Running};
use crate::server::Server;
use crate::wait_until;

/// An actuator that acknowledges every command, and a localisation that sends poses.
struct Outside {
    actuator: Listener,
    packets: Arc<Mutex<Vec<CommandPacket>>>,
    is_silent: Arc<AtomicBool>,
    are_poses_paused: Arc<AtomicBool>,
    has_ended: Arc<AtomicBool>,
}

impl Outside {
    fn new(broker: SocketAddr) -> Self {
        let packets = Arc::<Mutex<Vec<CommandPacket>>>::default();
        let (is_silent, are_poses_paused, has_ended) =
            (Arc::<AtomicBool>::default(), Arc::<AtomicBool>::default(), Arc::<AtomicBool>::default());
        let (own, silent) = (Arc::clone(&packets), Arc::clone(&is_silent));
        let actuator = Listener::new(broker, &Topic::Command.of("test"), move |client, arrival| {
            let packet = CommandPacket::from_bytes(&arrival.payload).unwrap();
            assert!(!arrival.is_retained, "a broker must not keep a command");
            own.lock().unwrap().push(packet);
            if !silent.load(Ordering::Relaxed) {
                let answer = packet.acknowledgement().to_vec();
                let _ = client.try_publish(Topic::Acknowledged.of("test"), answer, PublishOptions::at_most_once());
            }
        });
        let localisation = Listener::new(broker, "none", |_, _| {});
        let pose = Pose { position: Point2::origin(), heading: 0.0 };
        // A pose that the broker has kept is old, and the program must not take it.
        let old = PosePacket { sequence: u64::MAX, pose };
        localisation.publish(&Topic::Pose.of("test"), &old.to_bytes(), PublishOptions::at_most_once().retained());
        let (paused, ended) = (Arc::clone(&are_poses_paused), Arc::clone(&has_ended));
        std::thread::spawn(move || {
            for sequence in 1.. {
                if ended.load(Ordering::Relaxed) {
                    break;
                }
                if !paused.load(Ordering::Relaxed) {
                    let packet = PosePacket { sequence, pose }.to_bytes();
                    localisation.publish(&Topic::Pose.of("test"), &packet, PublishOptions::at_most_once());
                }
                std::thread::sleep(Duration::from_millis(5));
            }
        });
        Self { actuator, packets, is_silent, are_poses_paused, has_ended }
    }

    /// Waits for a command that arrives from now on.
    #[track_caller]
    fn wait_for(&self, wanted: impl Fn(&CommandPacket) -> bool) -> CommandPacket {
        let (before, mut found) = (self.packets.lock().unwrap().len(), None);
        wait_until("such a command", || {
            found = self.packets.lock().unwrap()[before..].iter().copied().find(&wanted);
            found.is_some()
        });
        found.unwrap()
    }
}

impl Drop for Outside {
    fn drop(&mut self) {
        self.has_ended.store(true, Ordering::Relaxed);
    }
}

/// Starts the program with all links over MQTT.
fn drive(name: &str, server: &Server, broker: SocketAddr) -> Running {
    let links =
        format!("mqtt: {{host: 127.0.0.1, port: {}}}\nactuator: {{mqtt: {{}}}}\npose: {{mqtt: {{}}}}\n", broker.port());
    Files::new(name, &links).drive(server)
}

#[test]
fn commands_and_poses_over_mqtt_drive_the_robot_and_stop_it() {
    let Some(mut broker) = Mosquitto::start() else { return };
    let (server, outside) = (Server::start(), Outside::new(broker.address));
    let (gate, listener) = (Gate::before(broker.address), Listener::of_all(broker.address));
    let mut program = drive("mqtt", &server, gate.address);
    let moving = outside.wait_for(|packet| !packet.is_stop && packet.command.velocity_world.norm() > 0.0);
    assert!(moving.command.velocity_world.norm() <= 0.2 + 1e-12, "the limit of the configuration");
    listener.wait_for_status(ONLINE);

    outside.is_silent.store(true, Ordering::Relaxed);
    outside.wait_for(|packet| packet.is_stop);
    outside.is_silent.store(false, Ordering::Relaxed);
    outside.wait_for(|packet| !packet.is_stop);
    outside.are_poses_paused.store(true, Ordering::Relaxed);
    outside.wait_for(|packet| packet.is_stop);
    outside.are_poses_paused.store(false, Ordering::Relaxed);
    outside.wait_for(|packet| !packet.is_stop);

    broker.kill();
    gate.close();
    std::thread::sleep(Duration::from_millis(500));
    let before: Vec<CommandPacket> = outside.packets.lock().unwrap().clone();
    broker.restart();
    // The robot comes back last, so that nothing of it is missed.
    listener.wait_for_subscription(2);
    outside.actuator.wait_for_subscription(2);
    gate.open();
    wait_until("a command after the outage", || outside.packets.lock().unwrap().len() > before.len());
    let (last, next) = (before[before.len() - 1], outside.packets.lock().unwrap()[before.len()]);
    assert!(next.is_stop && next.sequence > last.sequence + 20, "no command from the outage: {last:?} {next:?}");
    outside.wait_for(|packet| !packet.is_stop);
    wait_until("the report of the outage", || {
        let changes: Vec<_> = listener.on(Topic::Events).iter().map(Arrival::json).collect();
        let is = |change: &str| changes.iter().any(|e| e["fault"] == "broker_gone" && e["change"] == change);
        is("recovered")
    });

    program.terminate();
    assert!(program.wait().success());
    listener.wait_for_status(OFFLINE);
    assert!(outside.packets.lock().unwrap().last().is_some_and(|packet| packet.is_stop));
    let sequences: Vec<u64> = outside.packets.lock().unwrap().iter().map(|packet| packet.sequence).collect();
    assert!(sequences.is_sorted_by(|a, b| a < b), "no command comes twice or late");
    assert!(listener.on(Topic::State).last().unwrap().json()["state"].is_string());
}

#[test]
fn the_last_will_reports_a_program_that_says_no_farewell() {
    let Some(broker) = Mosquitto::start() else { return };
    let (server, listener) = (Server::start(), Listener::of_all(broker.address));
    let _outside = Outside::new(broker.address);
    let mut program = drive("will", &server, broker.address);
    listener.wait_for_status(ONLINE);
    program.0.kill().unwrap();
    listener.wait_for_status(OFFLINE);
    let later = Listener::of_all(broker.address);
    later.wait_for_status(OFFLINE);
    assert!(later.on(Topic::Status)[0].is_retained);
}
