//! Files with names that hardly anybody gives.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::{Command, Output};

use super::program::{directory, stderr, stdout};

/// Orders to a terminal: of its title, of a colour, with one letter for the two that begin an order, and of the direction.
const ORDERS: &str = "a\u{1b}]0;x\u{7}\u{1b}[31m\u{9b}32m\u{202e}b\u{2066}";
/// The same as it is shown.
const SHOWN: &str = "a\\u{1b}]0;x\\u{7}\\u{1b}[31m\\u{9b}32m\\u{202e}b\\u{2066}";

const GOOD: &str =
    "machine m\nuse \"laws.fsm\"\ninitial S\nstate S {\n  do still()\n  after 1 s -> Failure(\"late\")\n}\n";
const LAWS: &str = "library laws\n\nlaw still() { stop }\n";

fn run<S: AsRef<OsStr>>(directory: &Path, arguments: &[S]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vibrissa")).args(arguments).current_dir(directory).output().unwrap()
}

fn is_order(letter: char) -> bool {
    letter != '\n' && (letter.is_control() || ['\u{202e}', '\u{2066}'].contains(&letter))
}

#[test]
fn what_a_terminal_would_obey_is_shown_by_its_number() {
    let directory = directory("orders");
    let (good, bad) = (format!("{ORDERS}.fsm"), format!("{ORDERS}-bad.fsm"));
    std::fs::write(directory.join("laws.fsm"), LAWS).unwrap();
    std::fs::write(directory.join(&good), GOOD).unwrap();
    std::fs::write(directory.join(&bad), format!("machine m\ninitial S # {ORDERS}\nstate S {{ do {ORDERS} }}\n"))
        .unwrap();
    let missing = format!("{ORDERS}.yaml");
    let flag = format!("--{ORDERS}");
    for arguments in [
        vec!["check", &good],
        vec!["check", &bad],
        vec!["check", "--json", &good, &bad],
        vec!["check", &missing],
        vec!["run", &missing],
        vec!["run", &flag],
        vec![ORDERS],
        vec!["run", "x", "--seed", ORDERS],
        vec!["fmt", "--check", &good],
        vec!["fmt", &good],
        vec!["compile", &good, "-o", "made.machine"],
        vec!["graph", &missing],
        vec!["sweep", &missing],
    ] {
        let output = run(&directory, &arguments);
        let told = stdout(&output) + &stderr(&output);
        assert!(!told.contains(is_order), "{arguments:?}: {told:?}");
    }
    let output = run(&directory, &["check", &good]);
    assert!(output.status.success() && stdout(&output).starts_with(SHOWN), "{}", stdout(&output));
    assert!(stderr(&run(&directory, &["check", &bad])).contains(SHOWN));
    std::fs::write(directory.join(&good), GOOD.replace("  do", "do")).unwrap();
    let difference = stdout(&run(&directory, &["fmt", "--check", &good]));
    assert!(difference.starts_with(&format!("--- {SHOWN}.fsm\n+++ {SHOWN}.fsm (formatted)\n")), "{difference}");
    let usage = run(&directory, &["run", &flag]);
    assert_eq!(usage.status.code(), Some(2));
    assert!(stderr(&usage).contains(SHOWN), "{}", stderr(&usage));
    // Programs read what it was.
    let checked: serde_json::Value =
        serde_json::from_str(&stdout(&run(&directory, &["check", "--json", &good]))).unwrap();
    assert_eq!(checked[0]["file"], good);
}

#[test]
fn a_path_that_is_not_utf_8_is_told_and_can_be_avoided() {
    let directory = directory("not-utf-8");
    let folder = directory.join(OsStr::from_bytes(b"f\xff"));
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(folder.join("laws.fsm"), LAWS).unwrap();
    std::fs::write(folder.join("good.fsm"), GOOD).unwrap();
    for command in ["check", "fmt", "run", "graph", "compile", "sweep", "test"] {
        let path = folder.join("good.fsm");
        let mut arguments = vec![OsStr::new(command), path.as_os_str()];
        if command == "compile" {
            arguments.extend(["-o", "made.machine"].map(OsStr::new));
        }
        let output = run(&directory, &arguments);
        assert_eq!(output.status.code(), Some(2), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains("/f\\xff/good.fsm: its path is not UTF-8"), "{command}: {}", stderr(&output));
    }
    let output = run(&folder, &["check", "good.fsm"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let picture = directory.join(OsStr::from_bytes(b"g\xff.svg"));
    let output = run(&folder, &[OsStr::new("graph"), "good.fsm".as_ref(), "-o".as_ref(), picture.as_os_str()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(picture.is_file());
}

#[test]
fn built_in_names_are_accepted_wherever_a_file_is() {
    let directory = directory("built-in-names");
    let sweep = "name: one\npolicies: [thesis]\nscenes: [{scenario: disk}]\nvary: {scenario: {world: [quasistatic], stop: [{time: 1 s}]}}\n";
    std::fs::write(directory.join("one.yaml"), sweep).unwrap();
    for arguments in [
        &["check", "thesis"][..],
        &["graph", "thesis", "-o", "chart.svg"],
        &["compile", "thesis", "-o", "thesis.machine"],
        &["compare", "thesis", "vibrissa", "box", "--simulator", "quasistatic"],
        &[
            "run",
            "disk",
            "--policy",
            "thesis",
            "--mismatch",
            "plausible",
            "--uncalibrated",
            "--simulator",
            "quasistatic",
        ],
        &["families", "convex-corner", "--count", "1", "--policy", "thesis", "--simulator", "quasistatic"],
        &["sweep", "one.yaml", "--out", "swept"],
        &["inspect", "explain", "disk", "--policy", "thesis"],
    ] {
        let output = run(&directory, arguments);
        assert!(output.status.code() < Some(2), "{arguments:?}: {}", stderr(&output));
    }
}

#[test]
fn a_name_that_cannot_be_read_is_told_before_anything_else() {
    let directory = directory("wrong-names");
    for (arguments, meant) in [
        (&["compare", "thesis", "vibrisa", "box"][..], "policy is needed here; did you mean `vibrissa`?"),
        (&["compare", "thesis", "policies/vibrissa.fsm"], "policy is needed here; did you mean `vibrissa`?"),
        (&["run", "dsik"], "scenario is needed here; did you mean `disk`?"),
        (&["run", "disk", "--mismatch", "plausibel"], "mismatch is needed here; did you mean `plausible`?"),
    ] {
        let output = run(&directory, arguments);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(meant) && told.lines().count() == 1, "{told}");
    }
}
