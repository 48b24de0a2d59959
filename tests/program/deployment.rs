//! `vibrissa push` and `vibrissa-robot receive`, both as programs, with a local command in place of ssh.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::command::program::{ROOT, directory, stderr, stdout, vibrissa};

/// The program of the robot. A test of the whole workspace has built it.
fn robot_program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let folder = Path::new(env!("CARGO_BIN_EXE_vibrissa")).parent().unwrap();
        let program = folder.join("vibrissa-robot");
        if !program.exists() {
            let profile = folder.file_name().unwrap().to_str().unwrap();
            let profile = if profile == "debug" { "dev" } else { profile };
            let status = Command::new(env!("CARGO"))
                .args(["build", "--quiet", "--package", "vibrissa-robot", "--profile", profile, "--target-dir"])
                .arg(folder.parent().unwrap())
                .current_dir(ROOT)
                .status();
            assert!(status.unwrap().success());
        }
        program
    })
}

fn fixture(name: &str) -> String {
    format!("{ROOT}/crates/robot/tests/fixtures/store/{name}")
}

/// A robot with a store, behind a script in place of ssh.
struct Robot {
    folder: PathBuf,
}

impl Robot {
    /// A robot with an empty store. The host `robot` is reached. With `cut-N` only N bytes of the push arrive. With
    /// `mute` the connection ends before the answer. `other` has another program of that name.
    fn new(name: &str) -> Self {
        let folder = directory(&format!("push-{name}"));
        fs::create_dir(folder.join("store")).unwrap();
        let receive = format!(
            "'{}' receive --store '{}' --keys '{}'",
            robot_program().display(),
            folder.join("store").display(),
            fixture("")
        );
        let script = format!(
            "#!/bin/sh\n\
             host=$1; shift\n\
             [ \"$*\" = 'vibrissa-robot receive' ] || exit 99\n\
             case $host in\n\
             robot) exec {receive} ;;\n\
             cut-*) head -c \"${{host#cut-}}\" | {receive}; exit 255 ;;\n\
             mute) {receive} >&2; exit 255 ;;\n\
             other) cat >/dev/null; echo 'vibrissa-robot 9.9' ;;\n\
             none) exec no-such-program-of-a-robot ;;\n\
             esac\n"
        );
        let ssh = folder.join("ssh");
        fs::write(&ssh, script).unwrap();
        fs::set_permissions(&ssh, fs::Permissions::from_mode(0o755)).unwrap();
        Self { folder }
    }

    fn push(&self, host: &str, machine: &str, options: &[&str]) -> Output {
        let ssh = self.folder.join("ssh");
        vibrissa(&[&["push", host, &fixture(machine), "--via", ssh.to_str().unwrap()], options].concat())
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let store = self.folder.join("store");
        Command::new(robot_program()).args(arguments).arg("--store").arg(store).output().unwrap()
    }

    /// The status of the store, and its hashes of the good and of the tentative machine.
    fn status(&self) -> (Value, [Option<String>; 2]) {
        let status: Value =
            serde_json::from_str(&stdout(&self.run(&["status", "--json", "--keys", &fixture("")]))).unwrap();
        let hash = |role: &str| status[role]["hash"].as_str().map(str::to_owned);
        let hashes = ["good", "tentative"].map(hash);
        (status, hashes)
    }
}

/// SHA-256 of a file, by which the robot names a machine.
fn hash(machine: &str) -> String {
    let digest = Sha256::digest(fs::read(fixture(machine)).unwrap());
    digest.iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

#[test]
fn a_pushed_machine_is_in_the_store_of_the_robot_with_its_signer() {
    let robot = Robot::new("whole");
    let output = robot.push("robot", "1.machine", &["--key", &fixture("test.pub"), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let pushed: Value = serde_json::from_str(&stdout(&output)).unwrap();
    crate::command::schema::check("push", &pushed);
    assert_eq!([&pushed["hash"], &pushed["state"]], [&hash("1.machine"), "tentative"]);
    let (status, hashes) = robot.status();
    crate::command::schema::check("store", &status);
    assert_eq!(hashes, [None, Some(hash("1.machine"))]);
    assert_eq!([&status["tentative"]["signer"], &status["tentative"]["name"]], ["test.pub", "bang"]);
    assert!(robot.run(&["good"]).status.success());
    let again = stdout(&robot.push("robot", "1.machine", &[]));
    assert!(again.contains("1.machine is good"), "{again}");
}

/// The library tests cut a push at every byte. Here, both programs meet the cuts.
#[test]
fn a_push_that_is_cut_leaves_the_old_machine_or_the_new_one() {
    let robot = Robot::new("cut");
    assert!(robot.push("robot", "1.machine", &[]).status.success());
    assert!(robot.run(&["good"]).status.success());
    let old = [Some(hash("1.machine")), None];
    let length = ["2.machine", "2.machine.minisig"].map(|name| fs::metadata(fixture(name)).unwrap().len());
    let length = 20 + length[0] + length[1];
    let cuts = (0..24).chain((24..length).step_by(7)).chain(length - 3..length);
    for cut in cuts {
        let output = robot.push(&format!("cut-{cut}"), "2.machine", &[]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{cut}: {message}");
        assert!(message.contains("push the machine again, which is safe"), "{cut}: {message}");
        assert_eq!(robot.status().1, old, "{cut}");
    }
    // The robot has everything, but its answer is lost.
    let output = robot.push("mute", "2.machine", &[]);
    assert!(stderr(&output).contains("push the machine again, which is safe"), "{}", stderr(&output));
    let new = ["1.machine", "2.machine"].map(|name| Some(hash(name)));
    assert_eq!(robot.status().1, new);
    assert!(robot.push("robot", "2.machine", &[]).status.success());
    assert_eq!(robot.status().1, new);
}

#[test]
fn a_push_that_fails_says_what_to_do_and_changes_nothing() {
    let robot = Robot::new("refused");
    let unsigned = robot.folder.join("unsigned.machine");
    fs::copy(fixture("1.machine"), &unsigned).unwrap();
    let signature = |name: &str| ["--signature".to_owned(), fixture(name)];
    let key = |name: &str| ["--key".to_owned(), fixture(name)];
    let unsigned = unsigned.to_str().unwrap();
    let one = &fixture("1.machine")[..];
    let none: [String; 0] = [];
    for (host, machine, options, expected) in [
        ("robot", "nothing.machine", &none[..], "cannot read nothing.machine"),
        ("robot", unsigned, &none[..], "run `minisign -Sm "),
        ("robot", one, &signature("nothing.minisig")[..], "nothing.minisig"),
        (
            "robot",
            one,
            &signature("2.machine.minisig")[..],
            "did not take the machine: vibrissa-robot: the signature does not fit",
        ),
        ("robot", &fixture("format.machine"), &none[..], "the machine is in format 255"),
        ("robot", one, &key("other.pub")[..], "error: the machine is signed with a key that is not trusted"),
        ("robot", one, &key("1.machine")[..], "is not a public key"),
        ("other", one, &none[..], "use the same version on both computers"),
        ("none", one, &none[..], "does not find the program that receives"),
    ] {
        let ssh = robot.folder.join("ssh");
        let options: Vec<_> = options.iter().map(String::as_str).collect();
        let output = vibrissa(&[&["push", host, machine, "--via", ssh.to_str().unwrap()], &options[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{machine} {options:?}");
        assert!(stderr(&output).contains(expected), "{machine} {options:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "");
    }
    let output = vibrissa(&["push", "robot", one, "--via", "/nonexistent/ssh"]);
    assert!(stderr(&output).contains("cannot run /nonexistent/ssh"), "{}", stderr(&output));
    assert_eq!(robot.status().1, [None, None]);
}
