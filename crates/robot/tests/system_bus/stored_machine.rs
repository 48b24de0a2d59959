//! Driving the machine of a store.

use std::path::Path;
use std::time::{Duration, Instant};

use vibrissa_robot::store::{State, Tentative};

use crate::machines::{hash, run, state, store};
use crate::robot::Outside;
use crate::server::{Server, scratch};

/// A time that no run of a test reaches.
const NEVER: &str = "100000";
/// The longest wait for a state. It is only reached when the test fails.
const PATIENCE: Duration = Duration::from_secs(30);

fn wait_for(folder: &Path, wanted: impl Fn(&State) -> bool) {
    let before = Instant::now();
    while !wanted(&state(folder)) {
        assert!(before.elapsed() < PATIENCE, "{:?}", state(folder));
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_tentative_machine_that_crashes_is_replaced_by_the_old_one_at_the_next_start() {
    let server = Server::start();
    let outside = Outside::new("crash");
    let folder = store("crash");
    let mut child = outside.files.drive_store(&server, &folder, NEVER);
    outside.wait_for(|packet| !packet.is_stop && packet.command.velocity_world.norm() > 0.0);
    child.kill();
    assert_eq!(state(&folder).tentative, Some(Tentative { hash: hash(2), starts: 1 }));
    let mut child = outside.files.drive_store(&server, &folder, NEVER);
    wait_for(&folder, |state| state.tentative.is_none());
    let now = state(&folder);
    assert_eq!((now.good, now.rejected.unwrap().hash), (Some(hash(1)), hash(2)));
    // The commands of the killed program may still be in the socket.
    outside.wait_for(|packet| packet.is_stop && packet.sequence == 1);
    outside.wait_for(|packet| !packet.is_stop && packet.command.velocity_world.norm() > 0.0);
    child.terminate();
    assert!(child.wait().success());
}

#[test]
fn a_tentative_machine_that_runs_without_a_stop_is_good_also_after_a_crash() {
    let server = Server::start();
    let outside = Outside::new("good");
    let folder = store("good");
    let mut child = outside.files.drive_store(&server, &folder, "1");
    let watched = folder.clone();
    let waiting = std::thread::spawn(move || wait_for(&watched, |state| state.good == Some(hash(2))));
    // The commands must be acknowledged meanwhile.
    outside.wait_for(|_| waiting.is_finished());
    waiting.join().unwrap();
    child.kill();
    let now = state(&folder);
    assert_eq!((now.tentative, now.rejected), (None, None));
}

#[test]
fn a_device_that_cannot_be_used_is_not_the_fault_of_the_machine() {
    let outside = Outside::new("no-bus");
    let folder = store("no-bus");
    let output = run(&folder, &["drive", "--config", &outside.files.config], &[]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(state(&folder).tentative, Some(Tentative { hash: hash(2), starts: 0 }));
}

#[test]
fn a_machine_that_does_not_fit_the_rig_is_given_up() {
    let outside = Outside::new("other-rig");
    let folder = store("other-rig");
    let text = std::fs::read_to_string(&outside.files.config).unwrap();
    let whisker = |name: &str| format!("{name}: {{base: [0 mm, 20 mm], direction: 90 deg}}");
    let rig = format!("rig: {{whiskers: {{{}, {}}}}}\n", whisker("a"), whisker("b"));
    let config = scratch().join("other-whiskers.yaml");
    let text = text.replace("whisker: r0", "whisker: a").replace("whisker: l0", "whisker: b");
    std::fs::write(&config, text + &rig).unwrap();
    let output = run(&folder, &["drive", "--config", config.to_str().unwrap()], &[]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let now = state(&folder);
    assert_eq!((now.good, now.tentative), (Some(hash(1)), None));
    assert!(now.rejected.unwrap().reason.contains("r0"));
}
