//! Ctrl-C while many runs are done.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use super::program::{ROOT, directory, stderr, vibrissa};

/// Gives Ctrl-C to a command and all that it started, as a terminal does, once `may_end` says so of its id; the exit status and what it told.
fn interrupted(arguments: &[&str], mut may_end: impl FnMut(u32) -> bool) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.args(arguments).current_dir(ROOT).process_group(0).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    while !may_end(child.id()) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(child.try_wait().unwrap().is_none(), "it is done before it could be ended");
    let group = format!("-{}", child.id());
    assert!(Command::new("kill").args(["-INT", "--", &group]).status().unwrap().success());
    let status = child.wait().unwrap();
    let mut told = String::new();
    child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
    (status.code(), told)
}

/// Whether a process handles Ctrl-C by now: its runs are about to begin.
fn listens(process: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 0b10 != 0)
}

fn lines(path: &Path) -> usize {
    fs::read_to_string(path).map_or(0, |text| text.lines().count())
}

#[test]
fn a_sweep_says_where_its_results_are_and_goes_on_with_them() {
    let directory = directory("interrupted-sweep");
    let (file, out) = (directory.join("sweep.yaml"), directory.join("out"));
    let text = format!(
        "name: small\npolicies: [{ROOT}/policies/vibrissa.fsm]\nscenes: [{{family: convex-corner, trials: 24}}]\n\
         vary: {{scenario: {{world: [quasistatic]}}}}\n"
    );
    fs::write(&file, text).unwrap();
    let (results, out) = (out.join("results.jsonl"), out.display().to_string());
    let arguments = ["sweep", file.to_str().unwrap(), "--jobs", "1", "--out", &out];
    let (status, told) = interrupted(&arguments, |_| lines(&results) > 3);
    assert_eq!(status, Some(130), "{told}");
    let kept = lines(&results) - 1;
    assert!((3..24).contains(&kept), "{kept}");
    // A run may have been written that is not yet counted.
    let counts = [kept, kept - 1].map(|kept| format!("interrupted after {kept} of 24 runs"));
    assert!(counts.iter().any(|count| told.contains(count)), "{kept}: {told}");
    assert!(told.contains(&results.display().to_string()) && told.contains("resumes from them"), "{told}");
    assert!(!fs::read_to_string(&results).unwrap().contains("crashed"));
    let output = vibrissa(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(lines(&results), 25);
}

/// The results of a command without the times that runs took, and without the command and its date.
fn results(path: &Path) -> Vec<Value> {
    let text = fs::read_to_string(path).unwrap();
    let mut results: Vec<Value> = match serde_json::from_str(&text) {
        Ok(Value::Array(list)) => list,
        _ => text.lines().map(|line| serde_json::from_str(line).unwrap()).collect(),
    };
    for result in &mut results {
        for time in ["start_s", "wall_s", "realtime", "tick_us"] {
            result.as_object_mut().unwrap().remove(time);
        }
        if let Some(provenance) = result["provenance"].as_object_mut() {
            provenance.retain(|key, _| key != "command" && key != "date");
        }
    }
    results
}

#[test]
fn a_report_goes_on_with_its_finished_runs_and_says_the_same() {
    let directory = directory("interrupted-reports");
    let drawn = directory.join("drawn.yaml");
    fs::write(&drawn, "stiffness: [-5 %, 5 %]\n").unwrap();
    let mismatch = ["--mismatch", drawn.to_str().unwrap(), "--uncalibrated"];
    let many = [&["--simulator", "quasistatic", "--jobs", "1"][..], &mismatch].concat();
    let families = ["families", "convex-corner", "thin-wall", "--count", "12"];
    for (arguments, name) in [
        (&["bench", "--ideal", "--policy", "policies/thesis.fsm"][..], "results.json"),
        (&families[..], "results.jsonl"),
    ] {
        let [whole, parted] = ["whole", "parted"].map(|part| directory.join(format!("{}-{part}", arguments[0])));
        let [whole_out, parted_out] = [&whole, &parted].map(|path| path.display().to_string());
        let arguments = |out| [arguments, &many, &["--out", out]].concat();
        let status = vibrissa(&arguments(&whole_out)).status.code();
        let unfinished = parted.join("unfinished.jsonl");
        let (interruption, told) = interrupted(&arguments(&parted_out), |_| lines(&unfinished) > 4);
        assert_eq!(interruption, Some(130), "{told}");
        assert!(told.contains("unfinished.jsonl") && told.contains("resumes from them"), "{told}");
        let kept = fs::read_to_string(&unfinished).unwrap();

        let others = vibrissa(&[&arguments(&parted_out)[..], &["--mismatch-seed", "5"]].concat());
        assert_eq!(others.status.code(), Some(2));
        assert!(stderr(&others).contains("another version of the runs"), "{}", stderr(&others));
        assert_eq!(fs::read_to_string(&unfinished).unwrap(), kept);

        // The end that a kill in the middle of writing leaves.
        fs::write(&unfinished, kept + "{\"run\":7,\"fri").unwrap();
        let resumed = vibrissa(&arguments(&parted_out));
        assert_eq!(resumed.status.code(), status, "{}", stderr(&resumed));
        assert_eq!(results(&parted.join(name)), results(&whole.join(name)));
        let names = |folder: &Path| -> BTreeSet<_> {
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
        };
        assert_eq!(names(&parted), names(&whole));
    }
}

#[test]
fn what_keeps_nothing_says_so() {
    let many = ["--simulator", "quasistatic", "--jobs", "1"];
    let compare = ["compare", "policies/thesis.fsm", "policies/vibrissa.fsm", "--jitter", "10 mm", "--seeds", "100"];
    let families = ["families", "convex-corner", "--count", "200"];
    for arguments in [&compare[..], &families[..]] {
        let (status, told) = interrupted(&[arguments, &many].concat(), listens);
        assert_eq!(status, Some(130), "{arguments:?}: {told}");
        assert!(told.contains("interrupted after") && told.contains("not kept"), "{arguments:?}: {told}");
    }
}
