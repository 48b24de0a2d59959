//! `vibrissa sweep` and `vibrissa study merge`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// Runs in the directory that take some tenths of a second each, six for every policy and two settings.
fn sweep_in(directory: &Path) -> String {
    let text = format!(
        "name: small\npolicies: [{ROOT}/policies/vibrissa.fsm, {ROOT}/policies/thesis.fsm]\nscenes:\n  \
         - {{scenario: {ROOT}/scenarios/disk.yaml, trials: 4}}\n  - {{family: convex-corner, trials: 2}}\nvary:\n  \
         policy: {{speed: [4 cm/s, 5 cm/s]}}\n  \
         scenario: {{stop: [{{time: 8 s}}], rig.sensing.angle_noise: [0.5 urad]}}\n"
    );
    let path = directory.join("small.yaml").display().to_string();
    fs::write(&path, text).unwrap();
    path
}

const RUNS: usize = 24;

fn sweep(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.arg("sweep").args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// The lines of a file of results, without their origin and the times that runs took.
fn lines(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    let line = |line: &str| {
        let mut result: Value = serde_json::from_str(line).unwrap();
        for time in ["start_s", "wall_s", "realtime", "tick_us", "provenance"] {
            result.as_object_mut().unwrap().remove(time);
        }
        result.to_string()
    };
    text.lines().map(line).collect()
}

/// The same as a set, after looking that none is there twice.
fn set(path: &Path) -> BTreeSet<String> {
    let lines = lines(path);
    let set: BTreeSet<_> = lines.iter().cloned().collect();
    assert_eq!(set.len(), lines.len());
    set
}

fn wait_for(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_mins(2), "no {what} in two minutes");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn count(path: &Path) -> usize {
    fs::read(path).map_or(0, |bytes| String::from_utf8_lossy(&bytes).matches('\n').count())
}

/// The processes that a process has started.
#[cfg(target_os = "linux")]
fn children(parent: u32) -> Vec<u32> {
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let processes = processes.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let parent_of = |process: u32| {
        let status = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        status.rsplit_once(") ")?.1.split(' ').nth(1)?.parse::<u32>().ok()
    };
    processes.filter(|&process| parent_of(process) == Some(parent)).collect()
}

#[test]
fn a_sweep_that_was_killed_is_gone_on_with_and_gives_what_it_would_have_given() {
    let directory = directory("sweep-killed");
    let file = sweep_in(&directory);
    let [whole, killed] = ["whole", "killed"].map(|name| directory.join(name));
    let [whole_out, killed_out] = [&whole, &killed].map(|path| path.display().to_string());
    let output = vibrissa(&["sweep", &file, "--out", &whole_out, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(summary["groups"].as_array().unwrap().len(), 8);

    let results = killed.join("results.jsonl");
    for done in [3, 9] {
        let mut sweep = sweep(&[&file, "--jobs", "2", "--out", &killed_out]);
        wait_for("results", || count(&results) > done);
        // SIGKILL: it has no chance to say good-bye.
        sweep.kill().unwrap();
        sweep.wait().unwrap();
        // What a kill in the middle of writing leaves.
        let mut torn = fs::read(&results).unwrap();
        torn.extend(br#"{"run":"0123456789abcdef","key":"scen"#);
        fs::write(&results, torn).unwrap();
    }
    let output = vibrissa(&["sweep", &file, "--out", &killed_out, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert!(summary["resumed"].as_u64().unwrap() >= 9);
    let results = whole.join("results.jsonl");
    assert_eq!(lines(&results).len(), RUNS + 1);
    assert_eq!(set(&killed.join("results.jsonl")), set(&results));

    for (change, told) in [("text", "another text of the sweep"), ("shard", "the shard 1/1")] {
        let mut arguments = vec!["sweep", &file, "--out", &whole_out];
        if change == "text" {
            fs::write(&file, fs::read_to_string(&file).unwrap() + "# changed\n").unwrap();
        } else {
            sweep_in(&directory);
            fs::rename(&results, whole.join("shard-1-of-2.jsonl")).unwrap();
            arguments.extend(["--shard", "1/2"]);
        }
        let output = vibrissa(&arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(told), "{}", stderr(&output));
    }
}

#[test]
fn shards_are_merged_in_order_and_what_is_missing_or_twice_is_told() {
    let directory = directory("sweep-shards");
    let file = sweep_in(&directory);
    let out = |name: &str| directory.join(name).display().to_string();
    for shard in ["1/3", "2/3", "3/3"] {
        let output = vibrissa(&["sweep", &file, "--out", &out("shards"), "--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    assert_eq!(vibrissa(&["sweep", &file, "--out", &out("whole"), "--jobs", "1"]).status.code(), Some(0));
    let output = vibrissa(&["study", "merge", &out("shards")]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // One run at a time is in order by itself.
    let shards = directory.join("shards");
    assert_eq!(lines(&shards.join("results.jsonl")), lines(&directory.join("whole/results.jsonl")));
    // The result is one that a sweep goes on with.
    let output = vibrissa(&["sweep", &file, "--out", &out("shards"), "--json"]);
    let summary: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(summary["resumed"], RUNS);

    fs::remove_file(shards.join("results.jsonl")).unwrap();
    let second = shards.join("shard-2-of-3.jsonl");
    let text = fs::read_to_string(&second).unwrap();
    let (kept, last) = text.trim_end().rsplit_once('\n').unwrap();
    fs::write(&second, kept.to_owned() + "\n").unwrap();
    let output = vibrissa(&["study", "merge", &out("shards")]);
    assert_eq!(output.status.code(), Some(1));
    let key = serde_json::from_str::<Value>(last).unwrap()["key"].as_str().unwrap().to_owned();
    let told = stderr(&output);
    assert!(told.contains(&format!("missing: {key} (shard 2/3)")) && told.contains("1 run is missing"), "{told}");
    assert!(!shards.join("results.jsonl").exists());

    let output = vibrissa(&["study", "merge", &second.display().to_string(), &second.display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("both have the run"), "{}", stderr(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn a_process_for_runs_that_is_killed_costs_nothing_and_none_outlives_the_sweep() {
    let directory = directory("sweep-workers");
    let file = sweep_in(&directory);
    let out = directory.join("out");
    let results = out.join("results.jsonl");
    let mut sweep = sweep(&[&file, "--jobs", "1", "--out", &out.display().to_string()]);
    for done in [1, 2] {
        wait_for("results", || count(&results) > done);
        for worker in children(sweep.id()) {
            Command::new("kill").args(["-KILL", &worker.to_string()]).status().unwrap();
        }
    }
    wait_for("results", || count(&results) > 5);
    let workers = children(sweep.id());
    assert_eq!(workers.len(), 1);
    sweep.kill().unwrap();
    sweep.wait().unwrap();
    let stat = |worker: &u32| fs::read_to_string(format!("/proc/{worker}/stat")).unwrap_or_default();
    // One that has ended may be waiting for somebody to ask how.
    let is_gone = |worker: &u32| stat(worker).is_empty() || stat(worker).contains(") Z ");
    wait_for("end of the worker", || workers.iter().all(is_gone));
    // Each has run to its end, which is too early to meet the expectations of the scene.
    let has_ended = |line: &String| line.contains(r#""outcome":"ended""#);
    assert!(lines(&results).iter().skip(1).all(has_ended));
}

#[test]
fn a_run_without_a_result_is_repeated_and_a_line_that_contradicts_itself_is_refused() {
    let directory = directory("sweep-crashed");
    let file = directory.join("two.yaml").display().to_string();
    let text = format!(
        "name: two\npolicies: [{ROOT}/policies/vibrissa.fsm]\nscenes: [{{family: convex-corner, trials: 2}}]\n\
         vary: {{scenario: {{stop: [{{time: 1 s}}]}}}}\n"
    );
    fs::write(&file, text).unwrap();
    let [out, merged] = ["out", "merged.jsonl"].map(|name| directory.join(name).display().to_string());
    let results = Path::new(&out).join("results.jsonl");
    assert_eq!(vibrissa(&["sweep", &file, "--out", &out]).status.code(), Some(0));
    let whole = fs::read_to_string(&results).unwrap();
    let line = whole.lines().nth(2).unwrap();
    let mut crashed: Value = serde_json::from_str(line).unwrap();
    let keys = ["run", "key", "scenes", "trial", "settings", "passed", "policy"];
    crashed.as_object_mut().unwrap().retain(|key, _| keys.contains(&key.as_str()));
    crashed["outcome"] = "crashed".into();
    crashed["reason"] = "its process was killed".into();
    let refused = crashed.to_string().replace("crashed", "refused");
    // As if it had crashed, and had not begun at the second time.
    fs::write(&results, whole.replace(line, &format!("{crashed}\n{refused}"))).unwrap();
    assert_eq!(vibrissa(&["sweep", &file, "--out", &out]).status.code(), Some(0));
    assert_eq!(count(&results), 5, "the run has a third line");
    assert_eq!(vibrissa(&["sweep", &file, "--out", &out]).status.code(), Some(0));
    assert_eq!(count(&results), 5, "nothing is left");
    let output = vibrissa(&["study", "merge", &results.display().to_string(), "--out", &merged, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    fs::write(directory.join("whole.jsonl"), &whole).unwrap();
    assert_eq!(set(Path::new(&merged)), set(&directory.join("whole.jsonl")));

    let other = whole.lines().nth(1).unwrap();
    let name = |line: &str| serde_json::from_str::<Value>(line).unwrap()["run"].as_str().unwrap().to_owned();
    let changed = |key: &str, value: Value| {
        let mut line: Value = serde_json::from_str(line).unwrap();
        line[key] = value;
        line.to_string()
    };
    for (with, words) in [
        (line.replace(&name(line), &name(other)), "line 3: `run` is"),
        (changed("settings", serde_json::json!({"stop": "{time: 2 s}"})), "line 3: `settings` contradicts the key"),
        (changed("settings", serde_json::json!({})), "line 3: `settings` contradicts the key"),
        (changed("trial", 7.into()), "line 3: `trial` contradicts the key"),
        (changed("scenes", "polygon".into()), "line 3: `scenes` contradicts the key"),
        (changed("passed", true.into()), "line 3: `passed` is true, which contradicts `violations`"),
    ] {
        fs::write(&results, whole.replace(line, &with)).unwrap();
        for arguments in [&["sweep", &file, "--out", &out][..], &["study", "merge", &results.display().to_string()]] {
            let output = vibrissa(arguments);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}");
            assert!(stderr(&output).contains(words), "{words}: {}", stderr(&output));
        }
    }
}

#[test]
fn faults_of_a_sweep_and_of_what_it_names_are_told_with_their_place() {
    let directory = directory("sweep-faults");
    let file = directory.join("bad.yaml");
    let told = |text: &str| {
        fs::write(&file, text).unwrap();
        let output = vibrissa(&["sweep", &file.display().to_string(), "--out", &directory.display().to_string()]);
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(count(&directory.join("results.jsonl")), 0);
        stderr(&output)
    };
    let head = format!("name: bad\npolicies: [{ROOT}/policies/vibrissa.fsm]\n");
    let disk = format!("scenes: [{{scenario: {ROOT}/scenarios/disk.yaml}}]\n");
    let policy = "machine a  whisker r0  param speed = 5 cm/s in 0 .. 9 cm/s  initial A\n\
                  state A { steer r0 along vector(1, 0) at speed turning 0 deg/s }\n";
    fs::write(directory.join("slow.fsm"), policy).unwrap();
    let slow = "name: bad\npolicies: [slow.fsm]\nscenes: [{family: polygon}]\nvary: {policy: {speed: [0 cm/s]}}\n";
    for (text, code, place) in [
        ("name: bad\npolicies: [none.fsm]\nscenes: [{family: polygon}]\n".to_owned(), "S0401", "bad.yaml:2:12"),
        (format!("{head}scenes: [{{scenario: none.yaml}}]\n"), "S0401", "bad.yaml:3:21"),
        (format!("{head}{disk}vary: {{policy: {{sped: [2 cm/s]}}}}\n"), "S0502", "bad.yaml:4:24"),
        (format!("{head}{disk}vary: {{policy: {{speed: [5 cm/s, 2 deg]}}}}\n"), "S0502", "bad.yaml:4:33"),
        (format!("{head}{disk}vary: {{scenario: {{rig.physics.step: [1.5 ms]}}}}\n"), "S0303", "bad.yaml:4:38"),
        (format!("{head}{disk}vary: {{scenario: {{rig.physic.step: [1 ms]}}}}\n"), "S0101", "bad.yaml:4:23"),
        (format!("{head}{disk}vary: {{scenario: {{stop.time.x: [1 ms]}}}}\n"), "S0101", "bad.yaml:4:29"),
        (format!("{head}{disk}vary: {{scenario: {{stop.time: [1]}}}}\n"), "S0201", "bad.yaml:4:31"),
        (slow.to_owned(), "S0502", "bad.yaml:4:25"),
    ] {
        let told = told(&text);
        assert!(told.contains(&format!("error[{code}]")) && told.contains(place), "{code} at {place}, {text}\n{told}");
    }
}

#[test]
fn the_world_can_vary_and_is_that_of_the_result() {
    let directory = directory("sweep-worlds");
    let worlds: &[&str] = if cfg!(feature = "sim") { &["mujoco", "quasistatic"] } else { &["quasistatic"] };
    let file = directory.join("worlds.yaml");
    let text = format!(
        "name: worlds\npolicies: [{ROOT}/policies/vibrissa.fsm]\n\
         scenes: [{{scenario: {ROOT}/scenarios/disk.yaml}}, {{family: convex-corner}}]\n\
         vary: {{scenario: {{stop: [{{time: 1 s}}], world: [{}]}}}}\n",
        worlds.join(", ")
    );
    fs::write(&file, text).unwrap();
    let output = vibrissa(&["sweep", &file.display().to_string(), "--out", &directory.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = fs::read_to_string(directory.join("results.jsonl")).unwrap();
    let results: Vec<Value> = text.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(results.len(), 2 * worlds.len());
    for result in &results {
        assert_eq!(result["world"], result["settings"]["world"], "{result}");
        assert_eq!(result["outcome"], "ended", "one second is too short for the expectations");
    }
}

#[test]
fn results_stand_for_the_files_that_values_name_too() {
    let directory = directory("sweep-files");
    let calibration = |stiffness: &str| {
        let text = format!("vibrissa_calibration: 2\nabout: a test\nhinge_stiffness: {stiffness}\n");
        fs::write(directory.join("r0.yaml"), text).unwrap();
    };
    calibration("1.1");
    let file = directory.join("files.yaml");
    let text = format!(
        "name: files\npolicies: [{ROOT}/policies/vibrissa.fsm]\nscenes: [{{family: convex-corner}}]\n\
         vary: {{scenario: {{stop: [{{time: 1 s}}], rig.whiskers: [{{r0: {{calibration: r0.yaml}}, l0: {{}}}}]}}}}\n"
    );
    fs::write(&file, text).unwrap();
    // Wherever it is started: a value's file is beside the sweep.
    let sweep = || vibrissa(&["sweep", &file.display().to_string(), "--out", &directory.display().to_string()]);
    let output = sweep();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(sweep().status.code(), Some(0));
    calibration("1.2");
    let output = sweep();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("another version of file") && stderr(&output).contains("r0.yaml"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn merged_results_take_the_place_of_nothing_else() {
    let directory = directory("merge-place");
    let file = directory.join("one.yaml");
    let text = format!(
        "name: one\npolicies: [{ROOT}/policies/vibrissa.fsm]\nscenes: [{{family: convex-corner}}]\n\
         vary: {{scenario: {{stop: [{{time: 1 s}}]}}}}\n"
    );
    fs::write(&file, text).unwrap();
    let out = directory.display().to_string();
    for shard in ["1/2", "2/2"] {
        let output = vibrissa(&["sweep", &file.display().to_string(), "--out", &out, "--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let shard = directory.join("kept").display().to_string();
    fs::copy(directory.join("shard-1-of-2.jsonl"), &shard).unwrap();
    let others = directory.join("results.jsonl");
    fs::write(&others, "letters to a friend\n").unwrap();
    for (arguments, reason) in [
        (&["study", "merge", &out][..], "does not contain results of runs"),
        (&["study", "merge", &out, "--out", &shard], "holds results of the shard 1/2"),
    ] {
        let output = vibrissa(arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
    assert_eq!(fs::read_to_string(&others).unwrap(), "letters to a friend\n");
    fs::remove_file(&others).unwrap();
    // Again and again.
    for _ in 0..2 {
        assert_eq!(vibrissa(&["study", "merge", &out]).status.code(), Some(0));
    }
}

#[test]
fn results_that_are_something_else_are_left_alone() {
    let directory = directory("sweep-other");
    let file = sweep_in(&directory);
    let results: PathBuf = directory.join("results.jsonl");
    for text in ["letters to a friend", "letters\nto a friend\n", "{}\n"] {
        fs::write(&results, text).unwrap();
        let output = vibrissa(&["sweep", &file, "--out", &directory.display().to_string()]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("does not contain results of runs"), "{}", stderr(&output));
        assert_eq!(fs::read_to_string(&results).unwrap(), text);
    }
    let empty = directory.join("empty");
    fs::create_dir(&empty).unwrap();
    let output = vibrissa(&["study", "merge", &empty.display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("there are no results of a sweep"), "{}", stderr(&output));
}

#[test]
fn a_sweep_as_an_array_of_slurm_jobs_gives_what_it_gives_without() {
    let script = Path::new(ROOT).join("deploy/slurm/test.sh");
    let output = Command::new(script).arg(env!("CARGO_BIN_EXE_vibrissa")).output().unwrap();
    // It says so where Slurm is not installed, and ends well.
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
}
