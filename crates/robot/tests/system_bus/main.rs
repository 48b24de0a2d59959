//! The program of the robot on `/dev/i2c-N`, which a preloaded library answers by emulated sensors. Its threads on a bus
//! that panics.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod machines;
mod panic;
mod robot;
mod server;
mod store_commands;
mod stored_machine;

use std::net::UdpSocket;
use std::time::{Duration, Instant};

use robot::{Outside, program};
use server::Server;
use vibrissa_mlx90393_emulator::{BusFault, SensorFault};
use vibrissa_robot::fault::{FaultChange, FaultEvent, FaultKind};
use vibrissa_robot::link::PosePacket;
use vibrissa_runtime::geometry::{Point2, Pose};

#[test]
fn the_sensors_command_sees_every_board_at_the_rate_of_the_loop() {
    let server = Server::start();
    let outside = Outside::new("sensors");
    let output =
        program(&server, &["sensors", "--for", "2", "--json", "--config", &outside.files.config]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let last = &lines[lines.len() - 2..];
    assert_eq!(last.iter().map(|line| line["whisker"].as_str().unwrap()).collect::<Vec<_>>(), ["r0", "l0"]);
    for line in last {
        // A loaded machine loses rounds, but no reading is wrong.
        assert!(line["rate_hz"].as_u64().unwrap() > 100, "{line}");
        assert_eq!([&line["garbled"], &line["silent"], &line["saturated"]], [0, 0, 0], "{line}");
        assert!(line["field_microtesla"].as_f64().unwrap().abs() < 100.0, "{line}");
    }
}

#[test]
fn the_loop_moves_the_robot_stops_it_for_a_fault_resumes_stops_at_the_end_and_can_be_replayed() {
    let server = Server::start();
    let outside = Outside::new("drive");
    let mut child = outside.files.drive(&server);
    let moving = outside.wait_for(|packet| !packet.is_stop && packet.command.velocity_world.norm() > 0.0);
    assert!(moving.command.velocity_world.norm() <= 0.2 + 1e-12, "the limit of the configuration");
    server.inject_at(1, 0x0C, SensorFault::NoAcknowledge { transactions: None });
    outside.wait_for(|packet| packet.is_stop);
    server.clear_at(1, 0x0C);
    outside.wait_for(|packet| !packet.is_stop);
    server.inject(3, BusFault::STUCK);
    let before = Instant::now();
    outside.wait_for(|packet| packet.is_stop);
    assert!(before.elapsed() < Duration::from_secs(1), "the stop did not wait for the blocked call");
    server.clear(3);
    outside.wait_for(|packet| !packet.is_stop);
    outside.pause_poses(true);
    outside.wait_for(|packet| packet.is_stop);
    outside.pause_poses(false);
    outside.wait_for(|packet| !packet.is_stop);
    child.terminate();
    outside.wait_for(|packet| packet.is_stop);
    let status = child.wait();
    assert!(status.success(), "{status}");
    let replayed = outside.replay();
    assert!(replayed.difference.is_none() && !replayed.is_cut && replayed.ticks > 0, "{replayed:?}");
    let has_stopped = |kind| {
        let is_stop = |event: &FaultEvent| event.fault.kind == kind && event.change == FaultChange::Reacted;
        replayed.events.iter().any(is_stop)
    };
    for kind in [FaultKind::SensorLost, FaultKind::BusBlocked, FaultKind::PoseOld, FaultKind::Terminated] {
        assert!(has_stopped(kind), "{kind:?} in {:?}", replayed.events);
    }
}

#[test]
fn a_localisation_that_starts_again_is_followed_and_a_stranger_is_not() {
    let server = Server::start();
    let outside = Outside::new("poses");
    let mut child = outside.files.drive(&server);
    let moves = |packet: &vibrissa_robot::link::CommandPacket| packet.command.velocity_world.norm() > 0.0;
    outside.wait_for(moves);
    let stranger = UdpSocket::bind("127.0.0.2:0").unwrap();
    let pose = Pose { position: Point2::new(0.001, 0.0), heading: 0.0 };
    for sequence in [u64::MAX, 1 << 20, (1 << 20) + 1] {
        stranger.send_to(&PosePacket { sequence, pose }.to_bytes(), outside.poses).unwrap();
    }
    outside.restart_poses();
    let before = Instant::now();
    outside.wait_for(|packet| packet.is_stop);
    outside.wait_for(moves);
    assert!(before.elapsed() < Duration::from_secs(3), "{:?}", before.elapsed());
    child.terminate();
    outside.wait_for(|packet| packet.is_stop);
    assert!(child.wait().success());
    let events = outside.replay().events;
    for kind in [FaultKind::ForeignSender, FaultKind::PoseRestarted] {
        let is_it = |event: &FaultEvent| event.fault.kind == kind && event.change == FaultChange::Detected;
        assert!(events.iter().any(is_it), "{kind:?} in {events:?}");
    }
}

#[test]
fn poses_of_every_computer_are_refused_at_the_start() {
    let (server, outside) = (Server::start(), Outside::new("any"));
    let text = std::fs::read_to_string(&outside.files.config).unwrap();
    let local = format!("listen: '{}', from: 127.0.0.1", outside.poses);
    let text = text.replace(&local, &format!("listen: '0.0.0.0:{}'", outside.poses.port()));
    std::fs::write(&outside.files.config, text).unwrap();
    let arguments = ["drive", "--config", &outside.files.config, "--skip-admission", &outside.files.machine];
    let output = program(&server, &arguments).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("name the one of the localisation"), "{message}");
}

#[test]
fn a_device_without_the_bus_is_told_with_the_setting_that_enables_it() {
    let outside = Outside::new("missing");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa-robot"))
        .args(["sensors", "--for", "1", "--config", &outside.files.config])
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("/dev/i2c-1 cannot be opened") && message.contains("config.txt"), "{message}");
}
