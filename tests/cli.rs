//! The command line as its users meet it: what goes where, and with which exit status.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn vibrissa(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vibrissa")).args(arguments).current_dir(ROOT).output().unwrap()
}

/// The same with a text at its standard input.
fn vibrissa_reading(arguments: &[&str], text: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn bad(kind: &str) -> Vec<String> {
    let directory = Path::new(ROOT).join("tests/fixtures").join(kind).join("bad");
    let files = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some()).map(|file| file.display().to_string()).collect()
}

/// A directory of its own for one test, emptied before.
fn directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).unwrap();
    directory
}

#[test]
fn help_explains_every_command() {
    let help = stdout(&vibrissa(&["--help"]));
    for command in ["run", "bench", "compare", "check", "compile", "graph", "test", "fmt", "lsp", "mjcf"] {
        assert!(help.contains(command));
        let output = vibrissa(&[command, "--help"]);
        assert_eq!(output.status.code(), Some(0));
        assert!(stdout(&output).contains("Usage:"));
    }
}

#[test]
fn a_library_can_be_checked_and_not_compiled() {
    let corner = "tests/fixtures/policies/use/laws/corner.fsm";
    let output = vibrissa(&["check", corner]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), format!("{corner}: library corner, 1 law, 1 value\n"));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&vibrissa(&["check", corner, "--json"]))).unwrap();
    assert_eq!(checked[0]["library"], serde_json::json!({"name": "corner", "laws": ["wait"], "values": ["sharp"]}));
    let output = vibrissa(&["compile", corner, "-o", "/dev/null"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is a library"), "{}", stderr(&output));
}

#[test]
fn a_fault_in_a_file_that_is_used_is_told_with_its_path() {
    let folder = "tests/fixtures/policies/use";
    let output = vibrissa(&["check", &format!("{folder}/fault_in_a_library.fsm"), "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked[0]["diagnostics"][0]["file"], format!("{folder}/laws/faulty.fsm"));
    let output = vibrissa(&["check", &format!("{folder}/file_that_is_not_there.fsm")]);
    assert!(stderr(&output).contains("did you mean `corner.fsm`?"), "{}", stderr(&output));
}

#[test]
fn check_says_what_a_policy_consists_of() {
    let output = vibrissa(&["check", "policies/thesis.fsm", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked[0]["machine"]["name"], "thesis");
    assert_eq!(checked[0]["machine"]["states"][0]["name"], "Exploring");
    assert_eq!(checked[0]["diagnostics"], serde_json::json!([]));
    let output = vibrissa(&["check", "policies/thesis.fsm"]);
    assert!(stdout(&output).contains("Swiping"), "{}", stdout(&output));
}

#[test]
fn check_shows_a_state_in_a_state_below_it_and_farther_in_with_the_operations_of_both() {
    let policy = "tests/fixtures/charts/nested.fsm";
    let table = stdout(&vibrissa(&["check", policy]));
    let rows = ["Following ", "  Touching (initial) ", "    Swiping (initial) ", "    Pressing ", "  Searching "];
    let places: Vec<usize> = rows.iter().map(|row| table.find(&format!("\n {row}")).unwrap()).collect();
    assert!(places.is_sorted(), "{table}");
    let checked: serde_json::Value = serde_json::from_str(&stdout(&vibrissa(&["check", policy, "--json"]))).unwrap();
    let states = checked[0]["machine"]["states"].as_array().unwrap();
    let of = |name: &str| states.iter().find(|state| state["name"] == name).unwrap();
    assert_eq!((&of("Following")["parent"], &of("Swiping")["parent"]), (&serde_json::Value::Null, &"Touching".into()));
    let operations = |name: &str| of(name)["operations"].as_u64().unwrap();
    assert!(operations("Following") < operations("Touching") && operations("Touching") < operations("Swiping"));
}

#[test]
fn every_malformed_policy_is_refused_with_a_place_and_exit_status_2() {
    let files = bad("policies");
    assert!(files.len() >= 20);
    for file in files {
        let output = vibrissa(&["check", &file]);
        assert_eq!(output.status.code(), Some(2), "{file}");
        assert!(stderr(&output).contains(&format!("{file}:")), "{file}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{file}");
    }
}

#[test]
fn warnings_are_shown_and_refused_on_demand() {
    let warned = "tests/fixtures/policies/warn/overlap_of_touches.fsm";
    let output = vibrissa(&["check", warned]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("warning[P0512]") && stderr(&output).contains(&format!("{warned}:10:8")));
    assert!(stdout(&output).contains("Exploring"), "what the policy consists of is told all the same");
    let output = vibrissa(&["check", warned, "--deny-warnings", "--json"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(2), ""));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked[0]["diagnostics"][0]["severity"], "warning");
    assert_eq!(checked[0]["machine"]["name"], "warned");
    assert_eq!(vibrissa(&["check", "policies/thesis.fsm", "--deny-warnings"]).status.code(), Some(0));
}

#[test]
fn run_tells_the_warnings_of_a_policy_once() {
    let directory = directory("warned");
    let other = directory.join("other.yaml").display().to_string();
    let disk = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
    std::fs::write(&other, disk.replace("name: disk", "name: other")).unwrap();
    let warned = "tests/fixtures/policies/warn/parameter_never_used.fsm";
    // No run is needed to see them: a setting that does not exist ends the command before.
    let output = vibrissa(&["run", "scenarios/disk.yaml", &other, "--policy", warned, "--set", "nothing=1"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(stderr(&output).matches("warning[P0504]").count(), 1, "{}", stderr(&output));
}

#[test]
fn every_malformed_scenario_is_refused_with_a_place_and_exit_status_2() {
    let files = bad("scenarios");
    assert!(files.len() >= 20);
    for file in files {
        let output = vibrissa(&["run", &file, "--policy", "policies/thesis.fsm"]);
        assert_eq!(output.status.code(), Some(2), "{file}");
        assert!(stderr(&output).contains(&format!("{file}:")), "{file}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{file}");
    }
}

#[test]
fn unusable_arguments_have_exit_status_2_and_say_what_to_do() {
    let disk = "scenarios/disk.yaml";
    for (arguments, expected) in [
        (vec!["run", "scenarios/nothing.yaml"], "cannot read scenarios/nothing.yaml"),
        (vec!["run", disk, "--policy", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (vec!["run", disk, "--set", "sped=20 mm/s"], "no parameter `sped`"),
        (vec!["run", disk, "--set", "speed=20 deg"], "`speed` is"),
        (vec!["run", disk, "--set", "speed=2 m/s"], "must lie between"),
        (vec!["run", disk, "--set", "speed"], "NAME=VALUE"),
        (vec!["run", disk, "--set", "speed=20 mn/s"], "mn"),
        (vec!["run", disk, disk], "both called `disk`"),
        (vec!["run"], "SCENARIO"),
        (vec!["fly"], "fly"),
        (vec!["bench", "--policy", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (vec!["bench", "--policy", "policies/thesis.fsm", "--policy", "policies/thesis.fsm"], "both called `thesis`"),
        (vec!["bench", "--jobs", "0"], "--jobs"),
        (vec!["compare", "policies/thesis.fsm"], "1 policy is given; give two or more"),
        (vec!["compare", disk], "0 policies are given"),
        (vec!["compare", "policies/thesis.fsm", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (vec!["compare", "policies/thesis.fsm", "policies/bang.fsm", "a.yaml"], "cannot read a.yaml"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter", "5 deg"], "a length"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter=-5 mm"], "not negative"),
        (vec!["compare", "a.fsm", "b.fsm", "--seeds", "0"], "--seeds"),
        (vec!["fmt"], "POLICY"),
        (vec!["fmt", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (vec!["mjcf", "policies/thesis.fsm"], "policies/thesis.fsm:"),
        (vec!["graph", "scenarios/disk.yaml"], "scenarios/disk.yaml:"),
        (vec!["graph", "policies/thesis.fsm", "-o", "policies/nothing/chart.svg"], "policies/nothing/chart.svg"),
    ] {
        let output = vibrissa(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{arguments:?}");
    }
}

#[test]
fn a_file_that_cannot_be_read_keeps_no_other_from_being_checked() {
    let output = vibrissa(&["check", "--json", "policies/nothing.fsm", "policies/thesis.fsm"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(2), ""));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert!(checked[0]["error"].as_str().unwrap().contains("cannot read policies/nothing.fsm"));
    assert_eq!((&checked[0]["machine"], &checked[1]["error"]), (&serde_json::Value::Null, &serde_json::Value::Null));
    assert_eq!(checked[1]["machine"]["name"], "thesis");
    let output = vibrissa(&["check", "policies/thesis.fsm", "policies/nothing.fsm"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stdout(&output).contains("Swiping") && stderr(&output).contains("cannot read policies/nothing.fsm"));
}

#[test]
fn of_a_compiled_machine_the_text_is_asked_for_where_it_is_needed() {
    let machine = directory("text").join("thesis.machine").display().to_string();
    assert_eq!(vibrissa(&["compile", "policies/thesis.fsm", "-o", &machine]).status.code(), Some(0));
    for command in ["graph", "fmt"] {
        let output = vibrissa(&[command, &machine]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("give the policy that it was made from, thesis.fsm"), "{}", stderr(&output));
    }
}

#[test]
fn every_command_that_writes_takes_the_place_alike() {
    for command in ["run", "bench", "compile", "graph"] {
        assert!(stdout(&vibrissa(&[command, "--help"])).contains("-o, --out <"), "{command}");
    }
}

const UGLY: &str = "machine m\ninitial S\nstate S{stop}\n";
const LAID_OUT: &str = "machine m\ninitial S\nstate S { stop }\n";

#[test]
fn fmt_lays_out_files_in_place_and_leaves_alone_those_that_are() {
    let directory = directory("fmt");
    let [ugly, laid_out] = ["ugly.fsm", "laid_out.fsm"].map(|name| directory.join(name).display().to_string());
    std::fs::write(&ugly, UGLY).unwrap();
    std::fs::write(&laid_out, LAID_OUT).unwrap();
    let output = vibrissa(&["fmt", &ugly, &laid_out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
    assert_eq!(stderr(&output), format!("formatted {ugly}\n"));
    assert_eq!(std::fs::read_to_string(&ugly).unwrap(), LAID_OUT);
    assert_eq!(std::fs::read_to_string(&laid_out).unwrap(), LAID_OUT);
}

#[test]
fn fmt_check_shows_what_would_change_and_changes_nothing() {
    let directory = directory("fmt_check");
    let ugly = directory.join("ugly.fsm").display().to_string();
    std::fs::write(&ugly, UGLY).unwrap();
    let output = vibrissa(&["fmt", "--check", &ugly]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("\n-state S{stop}\n+state S { stop }\n"), "{}", stdout(&output));
    assert_eq!(std::fs::read_to_string(&ugly).unwrap(), UGLY);
    let output = vibrissa(&["fmt", "--check", "policies/thesis.fsm"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stdout(&output), "");
}

#[test]
fn fmt_reads_standard_input_and_prints() {
    let output = vibrissa_reading(&["fmt", "-"], UGLY);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), LAID_OUT);
    let output = vibrissa_reading(&["fmt", "-"], "machine");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("standard input:1:"), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
}

#[test]
fn fmt_leaves_a_text_that_cannot_be_read_and_goes_on_with_the_others() {
    let directory = directory("fmt_bad");
    let [bad, ugly] = ["bad.fsm", "ugly.fsm"].map(|name| directory.join(name).display().to_string());
    std::fs::write(&bad, "machine   m state {").unwrap();
    std::fs::write(&ugly, UGLY).unwrap();
    let output = vibrissa(&["fmt", &bad, &ugly]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains(&format!("{bad}:1:")), "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(&bad).unwrap(), "machine   m state {");
    assert_eq!(std::fs::read_to_string(&ugly).unwrap(), LAID_OUT);
    assert_eq!(vibrissa(&["fmt", "--check", &bad, &ugly]).status.code(), Some(2));
}

#[test]
fn a_compiled_machine_is_checked_as_its_policy_is() {
    let machine = directory("compile").join("thesis.machine");
    let machine = machine.to_str().unwrap();
    let output = vibrissa(&["compile", "policies/thesis.fsm", "-o", machine, "--set", "speed=20 mm/s"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("machine thesis"), "{}", stdout(&output));
    let check = |file| {
        let output = vibrissa(&["check", file, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_str::<serde_json::Value>(&stdout(&output)).unwrap()[0].clone()
    };
    let (compiled, text) = (check(machine), check("policies/thesis.fsm"));
    assert_eq!(compiled["machine"]["states"], text["machine"]["states"]);
    assert_eq!(compiled["machine"]["parameters"][0]["value"], "20 mm/s");
    assert_eq!(text["machine"]["parameters"][0]["value"], "50 mm/s");
    assert_eq!(compiled["compiled"]["file"], "thesis.fsm");
    assert_eq!(text["compiled"], serde_json::Value::Null);
    let output = vibrissa(&["check", machine]);
    assert!(stdout(&output).contains("compiled from thesis.fsm by vibrissa"), "{}", stdout(&output));
}

#[test]
fn compiling_twice_gives_the_same_bytes_and_a_machine_can_be_set_again() {
    let directory = directory("compile_twice");
    let file = |name: &str| directory.join(name).display().to_string();
    let compile = |from: &str, setting: &str, to: &str| {
        let output = vibrissa(&["compile", from, "--out", to, "--set", setting]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        std::fs::read(to).unwrap()
    };
    let (first, second, third) = (file("first"), file("second"), file("third"));
    let slow = compile("policies/thesis.fsm", "speed=20 mm/s", &first);
    let policy = Path::new(ROOT).join("policies/thesis.fsm").display().to_string();
    assert_eq!(compile(&policy, "speed=20 mm/s", &second), slow);
    let fast = compile(&first, "speed=30 mm/s", &third);
    assert_ne!(fast, slow);
    assert_eq!(fast, compile("policies/thesis.fsm", "speed=30 mm/s", &second));
}

#[test]
fn what_cannot_be_compiled_or_is_no_sound_machine_is_refused() {
    let directory = directory("refused");
    let file = |name: &str| directory.join(name).display().to_string();
    let (machine, damaged, cut) = (file("thesis.machine"), file("damaged"), file("cut"));
    assert_eq!(vibrissa(&["compile", "policies/thesis.fsm", "-o", &machine]).status.code(), Some(0));
    let mut bytes = std::fs::read(&machine).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() - 1]).unwrap();
    bytes[100] ^= 1;
    std::fs::write(&damaged, &bytes).unwrap();
    let bad = "tests/fixtures/policies/bad/name_unknown.fsm";
    for (arguments, expected) in [
        (vec!["check", &damaged], "is damaged"),
        (vec!["check", &cut], "cut off"),
        (vec!["run", "scenarios/disk.yaml", "--policy", &damaged], "is damaged"),
        (vec!["compile", bad, "-o", &cut], "P0201"),
        (vec!["compile", "policies/thesis.fsm", "-o", &cut, "--set", "speed=2 m/s"], "must lie between"),
        (vec!["compile", "policies/thesis.fsm"], "--out"),
        (vec!["compile", "policies/thesis.fsm", "-o", "policies/thesis.fsm"], "would overwrite what it is made from"),
        (vec!["compile", "policies/thesis.fsm", "-o", "nowhere/thesis.machine"], "cannot write nowhere/thesis.machine"),
    ] {
        let output = vibrissa(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{arguments:?}");
    }
    assert_eq!(std::fs::read(&cut).unwrap().len(), bytes.len() - 1, "nothing is written that is at fault");
}

#[test]
fn a_file_without_end_or_of_another_kind_is_refused_with_its_name_and_exit_status_2() {
    for (file, expected) in [("/dev/zero", "larger than 1 MiB"), ("tests/fixtures/latin1.txt", "not UTF-8")] {
        for arguments in [vec!["check", file], vec!["mjcf", file], vec!["run", file]] {
            let output = vibrissa(&arguments);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}");
            let message = stderr(&output);
            assert!(message.contains(&format!("cannot read {file}")) && message.contains(expected), "{message}");
        }
    }
}

#[test]
fn graph_prints_or_writes_a_statechart() {
    for (format, beginning) in [("svg", "<svg"), ("mermaid", "stateDiagram-v2\n"), ("dot", "digraph \"thesis\" {\n")] {
        let output = vibrissa(&["graph", "policies/thesis.fsm", "--format", format]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let printed = stdout(&output);
        assert!(printed.starts_with(beginning) && printed.contains("Swiping"), "{printed}");
        let file = directory("graph").join("chart").display().to_string();
        let output = vibrissa(&["graph", "policies/thesis.fsm", "--format", format, "-o", &file]);
        assert_eq!((output.status.code(), stdout(&output)), (Some(0), String::new()));
        assert_eq!(std::fs::read_to_string(file).unwrap(), printed);
    }
    assert!(stdout(&vibrissa(&["graph", "policies/thesis.fsm"])).starts_with("<svg"));
}

#[test]
fn mjcf_prints_the_model() {
    let output = vibrissa(&["mjcf", "scenarios/disk.yaml"]);
    assert_eq!(output.status.code(), Some(0));
    let model = stdout(&output);
    assert!(model.starts_with("<mujoco") && model.contains(r#"type="cylinder""#));
}

#[cfg(feature = "sim")]
mod with_simulation {
    use super::{directory, stderr, stdout, vibrissa};
    use serde_json::Value;

    /// The keys of a JSON value, with those of objects within, sorted.
    fn keys(value: &Value, prefix: &str, into: &mut Vec<String>) {
        for (key, inner) in value.as_object().into_iter().flatten() {
            into.push(format!("{prefix}{key}"));
            keys(inner, &format!("{prefix}{key}."), into);
        }
        into.sort();
    }

    #[test]
    fn run_prints_results_as_json_and_nothing_else() {
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let result = &results[0];
        let mut found = Vec::new();
        keys(result, "", &mut found);
        let mut expected = [
            "scenario",
            "policy",
            "world",
            "seed",
            "outcome",
            "reason",
            "final_state",
            "sim_s",
            "wall_s",
            "realtime",
            "error_mm",
            "error_mm.mean",
            "error_mm.std",
            "error_mm.p95",
            "error_mm.max",
            "error_mm.n",
            "coverage",
            "hausdorff_mm",
            "retrieval",
            "failsafes",
            "failsafes.count",
            "failsafes.first_s",
            "failsafes.first_state",
            "failsafes.first_cause",
            "axis_mm",
            "corners",
            "states",
            "states.Exploring",
            "states.Swiping",
            "path_m",
            "path_ratio",
            "collisions",
            "collisions.count",
            "collisions.time_s",
            "tick_us",
            "tick_us.mean",
            "tick_us.p99",
            "tick_us.max",
            "hash",
            "hash.scenario",
            "hash.policy",
            "hash.engine",
        ]
        .map(str::to_owned);
        expected.sort();
        assert_eq!(found, expected);
        assert_eq!(result["outcome"], "completed");
        assert!(result["error_mm"]["mean"].as_f64().unwrap() <= 0.8);
        assert!(result["coverage"].as_f64().unwrap() >= 0.95);
    }

    #[test]
    fn a_compiled_machine_runs_as_its_policy_does() {
        let machine = directory("run_compiled").join("thesis.machine").display().to_string();
        assert_eq!(vibrissa(&["compile", "policies/thesis.fsm", "-o", &machine]).status.code(), Some(0));
        let felt = |policy: &str| {
            let output = vibrissa(&["run", "scenarios/disk.yaml", "--policy", policy, "--json"]);
            let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
            ["error_mm", "coverage", "sim_s", "final_state"].map(|key| results[0][key].clone())
        };
        assert_eq!(felt(&machine), felt("policies/thesis.fsm"));
    }

    #[test]
    fn an_expectation_that_fails_has_exit_status_1_and_says_which() {
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--set", "limit=300 urad"]);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("the outcome is failed, expected completed"), "{}", stderr(&output));
    }

    #[test]
    fn the_bench_runs_its_scenes_and_reports_them() {
        let out = directory("bench");
        let slow = directory("bench-policy").join("slow.machine").display().to_string();
        let compile = ["compile", "policies/thesis.fsm", "-o", &slow, "--set", "speed=60 mm/s"];
        assert_eq!(vibrissa(&compile).status.code(), Some(0));
        let shown = out.display().to_string();
        let output = vibrissa(&["bench", "--policy", &slow, "--out", &shown, "--json", "--jobs", "2"]);
        let rows: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let rows = rows.as_array().unwrap();
        let passed = rows.iter().all(|row| row["passed"] == true);
        assert_eq!(output.status.code(), Some(i32::from(!passed)), "{}", stderr(&output));
        let disk = rows.iter().find(|row| row["scenario"] == "disk").unwrap();
        assert_eq!(
            (&disk["thesis"]["error_mm"]["mean"], &disk["verdicts"]["error_mm"]),
            (&0.8.into(), &"better".into())
        );
        let mut files: Vec<_> =
            out.read_dir().unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        files.sort();
        assert_eq!(files.len(), rows.len() + 2, "{files:?}");
        assert!(files.contains(&"disk-thesis.svg".to_owned()) && files.contains(&"index.html".to_owned()));
        let written = std::fs::read_to_string(out.join("results.json")).unwrap();
        assert_eq!(&serde_json::from_str::<Vec<Value>>(&written).unwrap(), rows);
    }

    #[test]
    fn compare_does_the_same_runs_under_every_policy_on_however_many_threads() {
        let compared = |jobs: &str| {
            let disk = "scenarios/disk.yaml";
            let jitter = ["--seeds", "3", "--jitter", "10 mm", "--jitter-heading", "2 deg"];
            let arguments = ["compare", "policies/bang.fsm", "policies/thesis.fsm", disk, "--json", "--jobs", jobs];
            let output = vibrissa(&[&arguments[..], &jitter].concat());
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            stdout(&output)
        };
        let text = compared("2");
        assert_eq!(text, compared("1"));
        let comparison: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(comparison["policies"][0]["runs"], 3);
        let figures = comparison["figures"].as_array().unwrap();
        let time = figures.iter().find(|figure| figure["figure"] == "sim_s").unwrap();
        assert_eq!((&time["policy"], &time["outlook"]), (&"policies/thesis.fsm".into(), &"better".into()));
    }

    #[test]
    fn compare_does_a_run_once_that_no_seed_can_change() {
        let output =
            vibrissa(&["compare", "policies/thesis.fsm", "policies/thesis.fsm", "scenarios/disk.yaml", "--seeds", "9"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(stderr(&output).contains("all seeds are the same run"), "{}", stderr(&output));
        assert!(stdout(&output).contains("the same"), "{}", stdout(&output));
    }

    #[test]
    fn a_report_is_a_picture_and_the_result() {
        let directory = directory("report");
        let out = directory.join("new").display().to_string();
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--out", &out]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(stdout(&output).contains("disk.svg"));
        let picture = std::fs::read_to_string(directory.join("new/disk.svg")).unwrap();
        assert!(picture.starts_with("<svg"));
        let result = std::fs::read_to_string(directory.join("new/disk.json")).unwrap();
        assert!(serde_json::from_str::<Value>(&result).unwrap().is_object());
    }
}

#[cfg(not(feature = "sim"))]
#[test]
fn a_build_without_the_simulator_says_so() {
    let output = vibrissa(&["run", "scenarios/disk.yaml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("feature `sim`"), "{}", stderr(&output));
}

#[test]
fn a_test_names_a_scenario_that_can_be_read() {
    let policy = directory("test-without-scenario").join("policy.fsm");
    let test = "test \"it runs\" in \"nowhere.yaml\" { expect run.completed }";
    std::fs::write(&policy, format!("machine m initial Still state Still {{ stop }} {test}")).unwrap();
    let output = vibrissa(&["test", policy.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("P0702") && stderr(&output).contains("nowhere.yaml"), "{}", stderr(&output));
}

#[test]
fn a_filter_that_no_title_passes_is_unusable() {
    let output = vibrissa(&["test", "policies/thesis.fsm", "--filter", "flies"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`flies`"));
}

#[cfg(feature = "sim")]
#[test]
fn tests_pass_or_show_what_was_measured() {
    let policy = directory("tests").join("policy.fsm");
    let scenario = Path::new(ROOT).join("scenarios/disk.yaml");
    let scenario = scenario.display();
    let text = format!(
        "machine m param patience = 60 s in 1 .. 60 s
         initial Still state Still {{ stop after patience -> Late }} state Late {{ stop after 1 s -> Failure(\"late\") }}
         test \"it gives up\" in \"{scenario}\" {{
           set patience = 2 s
           expect run.failed and run.time_in(Late) > 0.9 s and run.time < patience + 1.2 s and run.visits(Late) == 1
         }}
         test \"it feels something\" in \"{scenario}\" {{ set patience = 1 s  expect run.error_mean < 1 mm or run.completed }}"
    );
    std::fs::write(&policy, text).unwrap();
    let output = vibrissa(&["test", policy.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let tests: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!([&tests[0]["passed"], &tests[1]["passed"]], [true, false]);
    assert_eq!(tests[1]["diagnostics"][0]["secondary"][0]["label"], "is not known");
    assert_eq!(tests[1]["diagnostics"][0]["secondary"][1]["label"], "is false");

    let output = vibrissa(&["test", policy.to_str().unwrap(), "--filter", "gives up"]);
    assert_eq!((output.status.code(), stdout(&output).ends_with("1 test, 0 failed\n")), (Some(0), true));
}

#[cfg(feature = "sim")]
#[test]
fn the_policies_pass_their_own_tests() {
    let output = vibrissa(&["test", "policies/thesis.fsm", "policies/bang.fsm"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("policies/thesis.fsm: ") && stdout(&output).contains("policies/bang.fsm: "));
}

#[cfg(not(feature = "lsp"))]
#[test]
fn a_build_without_the_language_server_says_how_to_get_it() {
    let output = vibrissa(&["lsp"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--features lsp"), "{}", stderr(&output));
}
