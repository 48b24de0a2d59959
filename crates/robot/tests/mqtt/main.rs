//! Telemetry, commands and poses over a real MQTT broker, Mosquitto, which each test starts for itself. One test also starts a
//! database, InfluxDB.
//!
//! Without the program `mosquitto` or `influxd`, the tests are skipped with a message. In CI they fail.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod access;
mod database;
mod drive;
mod emulated;
mod gate;
mod listener;
mod lockstep;
mod mosquitto;
mod outage;
mod page;
#[path = "../system_bus/robot.rs"]
#[expect(dead_code, reason = "the other test uses UDP")]
mod robot;
#[path = "../system_bus/server.rs"]
#[expect(dead_code, reason = "the other test injects faults")]
mod server;
mod services;
mod topics;

use std::time::{Duration, Instant};

/// The longest wait. It is only reached when a test fails.
const PATIENCE: Duration = Duration::from_secs(30);

/// Waits until a condition holds.
#[track_caller]
fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let before = Instant::now();
    while !condition() {
        assert!(before.elapsed() < PATIENCE, "{what} did not happen");
        std::thread::sleep(Duration::from_millis(5));
    }
}
