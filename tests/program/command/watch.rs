//! `run --watch` as its user meets it: save, and see.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

/// A program that is ended with the test.
struct Watching {
    child: Child,
    lines: Receiver<String>,
}

impl Watching {
    fn new(folder: &Path, scenario: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        command.args(["run", scenario, "--watch"]).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let (sender, lines) = channel();
        let (out, told) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let from_told = sender.clone();
        thread::spawn(move || BufReader::new(out).lines().try_for_each(|line| sender.send(line.unwrap())));
        thread::spawn(move || BufReader::new(told).lines().try_for_each(|line| from_told.send(line.unwrap())));
        Self { child, lines }
    }

    /// Reads on until a line has `text` in it.
    fn until(&self, text: &str) {
        while !self.lines.recv().unwrap().contains(text) {}
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

/// A stack that no machine has room for: no thread can be started.
#[test]
fn without_a_thread_that_watches_it_is_told_what_to_do() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.args(["run", "scenarios/disk.yaml", "--watch"]).current_dir(env!("CARGO_MANIFEST_DIR"));
    let output = command.env("RUST_MIN_STACK", (1_u64 << 46).to_string()).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.starts_with("error: cannot watch files") && told.contains("run without --watch"), "{told}");
}

#[test]
fn saving_a_policy_runs_it_again_and_breaks_off_the_run_before() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("watch");
    std::fs::create_dir_all(&folder).unwrap();
    let scenario = std::fs::read_to_string(root.join("scenarios/disk.yaml")).unwrap();
    // An hour: no run ends by itself.
    let scenario = scenario.replace("../policies/thesis.fsm", "policy.fsm").replace("time: 120 s", "time: 3600 s");
    std::fs::write(folder.join("disk.yaml"), scenario).unwrap();
    let policy = folder.join("policy.fsm");
    let still = |state: &str| format!("machine still initial {state} state {state} {{ stop }}");

    std::fs::write(&policy, still("First")).unwrap();
    let watching = Watching::new(&folder, "disk.yaml");
    watching.until("2 s  First");

    // As editors do it: a new file in the place of the old one.
    std::fs::write(folder.join("policy.new"), still("Second")).unwrap();
    std::fs::rename(folder.join("policy.new"), &policy).unwrap();
    watching.until("1 s  Second");

    std::fs::write(&policy, "machine still initial Third").unwrap();
    watching.until("P0201");
    watching.until("Ctrl-C");

    std::fs::write(&policy, still("Third")).unwrap();
    watching.until("1 s  Third");
}
