//! `vibrissa run`

use super::program::{directory, stderr, stdout, vibrissa};

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
fn a_policy_that_is_not_there_is_told_at_the_place_that_names_it() {
    let directory = directory("policy-missing");
    let scenario = directory.join("disk.yaml");
    let disk = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
    std::fs::write(&scenario, disk.replace("policy: ../policies/thesis.fsm", "policy: tesis.fsm")).unwrap();
    std::fs::copy("policies/thesis.fsm", directory.join("thesis.fsm")).unwrap();
    let line = 1 + std::fs::read_to_string(&scenario).unwrap().lines().position(|line| line.contains("tesis")).unwrap();
    for command in [&["run"][..], &["inspect", "explain"]] {
        let output = vibrissa(&[command, &[scenario.to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(2));
        let told = stderr(&output);
        for wanted in ["error[S0401]", &format!("disk.yaml:{line}:9"), "did you mean `thesis.fsm`?"] {
            assert!(told.contains(wanted), "{wanted}: {told}");
        }
    }
}

#[test]
fn built_in_scenes_and_policies_have_names_everywhere() {
    let folder = directory("built-in-names");
    let run = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        let output = command.current_dir(&folder).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        stdout(&output)
    };
    let figures = |arguments: &[&str]| {
        let text = run(&[&["run", "--simulator", "quasistatic", "--json"], arguments].concat());
        let mut results: serde_json::Value = serde_json::from_str(&text).unwrap();
        ["scene", "policy", "error_mm"].map(|key| results[0][key].take())
    };
    // The scene of the disk names `thesis.fsm`.
    let own = figures(&["disk"]);
    assert_eq!(own[1], "thesis");
    assert_eq!(own, figures(&["disk", "--policy", "thesis"]));
    assert_eq!(figures(&["box", "--policy", "vibrissa"])[1], "vibrissa");
    assert!(run(&["inspect", "explain", "round-tunnel"]).contains("steps"));
    assert!(run(&["check", "thesis"]).contains("thesis"));
    assert!(run(&["inspect", "mjcf", "wall"]).contains("<mujoco"));
    // A file of that name comes first.
    std::fs::write(folder.join("disk"), "name: disk\n").unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa"))
        .current_dir(&folder)
        .args(["run", "disk"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`objects`"), "{}", stderr(&output));
}

#[test]
fn a_scenario_sets_parameters_of_its_policy_and_the_command_line_sets_them_again() {
    let folder = directory("policy-set");
    let disk = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
    let thesis = std::fs::canonicalize("policies/thesis.fsm").unwrap().display().to_string();
    let scene = |set: &str| {
        let path = folder.join("disk.yaml").display().to_string();
        let policy = format!("policy: {{file: {thesis}, set: {set}}}");
        std::fs::write(&path, disk.replace("policy: ../policies/thesis.fsm", &policy)).unwrap();
        path
    };
    let time = |path: &str, arguments: &[&str]| {
        let output = vibrissa(&[&["run", path, "--simulator", "quasistatic", "--json"], arguments].concat());
        let results: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        results[0]["sim_s"].as_f64().unwrap()
    };
    let slow = time(&scene("{speed: 40 mm/s}"), &[]);
    assert!(slow > 1.2 * time("scenarios/disk.yaml", &[]));
    assert_eq!(slow.to_bits(), time("scenarios/disk.yaml", &["--set", "speed=40 mm/s"]).to_bits());
    assert!(time(&scene("{speed: 40 mm/s}"), &["--set", "speed=60 mm/s"]) < slow / 1.2);
    for (set, code, reason) in [
        ("{sped: 40 mm/s}", "S0502", "no parameter `sped`"),
        ("{speed: 40 deg}", "S0502", "`speed` is a speed"),
        ("{speed: 40 m/s}", "S0502", "`speed`"),
        ("{speed: [1]}", "S0103", "a number with its unit"),
        ("3", "S0103", "a mapping"),
    ] {
        let output = vibrissa(&["run", &scene(set)]);
        assert_eq!(output.status.code(), Some(2), "{set}");
        let told = stderr(&output);
        assert!(told.contains(code) && told.contains(reason), "{set}: {told}");
    }
}

#[test]
fn a_scene_that_a_family_prints_runs_as_it_is_and_as_it_says_at_its_speed() {
    let path = directory("printed").join("scene.yaml").display().to_string();
    let result = |arguments: &[&str]| {
        let output = vibrissa(&[arguments, &["--simulator", "quasistatic", "--json"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let mut results: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        ["policy", "outcome", "sim_s", "error_mm", "coverage"].map(|key| results[0][key].take())
    };
    let printed = stdout(&vibrissa(&["families", "convex-corner", "--trial", "0", "--print"]));
    std::fs::write(&path, &printed).unwrap();
    assert_eq!(result(&["run", &path])[..2], ["vibrissa", "completed"]);
    let set = printed.lines().next().unwrap().split('"').nth(1).unwrap();
    let trial = ["families", "convex-corner", "--trial", "0"];
    let as_drawn = result(&["run", &path, "--set", set]);
    assert_eq!(as_drawn, result(&trial));
    let bent = result(&["run", &path, "--set", set, "--set", "spying=20 mm/s"]);
    assert_eq!(bent, result(&[&trial[..], &["--set", "spying=20 mm/s"]].concat()));
    assert_ne!(bent, as_drawn);
}

#[cfg(feature = "outlines")]
#[test]
fn a_scenario_finds_its_outlines_beside_itself_and_tells_of_one_that_is_not_there() {
    let model = vibrissa(&["inspect", "mjcf", "scenarios/outlines/gripper.yaml"]);
    assert_eq!(model.status.code(), Some(0), "{}", stderr(&model));
    let directory = directory("outlines");
    let scenario = std::fs::read_to_string("scenarios/outlines/gripper.yaml").unwrap();
    std::fs::copy("scenarios/outlines/gripper.svg", directory.join("griper.svg")).unwrap();
    std::fs::write(directory.join("gripper.yaml"), scenario).unwrap();
    let output = vibrissa(&["inspect", "mjcf", &directory.join("gripper.yaml").display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("did you mean `griper.svg`?"), "{}", stderr(&output));
}

#[cfg(feature = "sim")]
mod with_simulation {
    use std::collections::BTreeSet;

    use serde_json::Value;
    use vibrissa::figures::FIGURES;

    use crate::command::program::{directory, stderr, stdout, vibrissa};

    /// The keys of a JSON value, with those of objects within, sorted.
    fn keys(value: &Value, prefix: &str, into: &mut Vec<String>) {
        for (key, inner) in value.as_object().into_iter().flatten() {
            into.push(format!("{prefix}{key}"));
            keys(inner, &format!("{prefix}{key}."), into);
        }
        into.sort();
    }

    /// The keys of a result that are neither figures nor groups of them.
    const KEYS: [&str; 64] = [
        "passed_but_for_tips",
        "violations",
        "whiskers",
        "provenance",
        "provenance.command",
        "provenance.version",
        "provenance.commit",
        "provenance.date",
        "provenance.simulators",
        "provenance.scenes",
        "provenance.policies",
        "provenance.hashes",
        "provenance.hashes.policies",
        "provenance.hashes.scenarios",
        "provenance.seeds",
        "provenance.jitter",
        "provenance.mismatches",
        "provenance.calibrations",
        "outline_coverages",
        "mismatch",
        "calibration",
        "true_tips",
        "format",
        "version",
        "scenario",
        "policy",
        "world",
        "seed",
        "outcome",
        "reason",
        "final_state",
        "start_s",
        "wall_s",
        "realtime",
        "largest_error",
        "largest_error.error_mm",
        "largest_error.tip_m",
        "largest_error.time_s",
        "largest_error.state",
        "largest_error.whisker",
        "failsafes",
        "failsafes.count",
        "failsafes.first_s",
        "failsafes.first_state",
        "failsafes.first_cause",
        "states",
        "states.Attaching",
        "states.Following",
        "states.Meeting",
        "states.Searching",
        "states.Turning",
        "collisions.first_position_m",
        "collisions.first_s",
        "collisions.first_state",
        "contracts",
        "inclination.whisker",
        "inclination.time_s",
        "inclination.tip_m",
        "inclination.state",
        "inclination.beyond_states",
        "hash",
        "hash.scenario",
        "hash.policy",
        "hash.engine",
    ];

    /// The keys of the figures that a result has, with their groups. Below a group that is null there are none.
    fn figure_keys(result: &Value) -> BTreeSet<&'static str> {
        let keys = FIGURES.iter().filter_map(|figure| figure.key);
        let with_groups = keys.flat_map(|key| {
            let groups = key.match_indices('.').map(move |(dot, _)| &key[..dot]);
            groups.chain([key])
        });
        let is_in_null = |key: &str| {
            key.match_indices('.')
                .any(|(dot, _)| result.pointer(&format!("/{}", key[..dot].replace('.', "/"))) == Some(&Value::Null))
        };
        with_groups.filter(|key| !is_in_null(key)).collect()
    }

    #[test]
    fn run_prints_results_as_json_and_nothing_else() {
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let result = &results[0];
        let mut found = Vec::new();
        keys(result, "", &mut found);
        let mut expected: Vec<String> = figure_keys(result).into_iter().chain(KEYS).map(str::to_owned).collect();
        expected.sort();
        assert_eq!(found, expected);
        assert_eq!(result["outcome"], "completed");
        assert!(result["error_mm"]["mean"].as_f64().unwrap() <= 0.8);
        assert!(result["coverage"].as_f64().unwrap() >= 0.95);
    }

    #[test]
    fn ticks_go_to_a_file_one_line_each() {
        let path = directory("ticks").join("ticks.jsonl");
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--json", "--ticks", &path.display().to_string()]);
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(lines.last().unwrap()["time_s"], results[0]["sim_s"]);
        let recorded = |line: &&Value| line["whiskers"][0]["recorded"] == true;
        assert_eq!(
            lines.iter().filter(recorded).count(),
            usize::try_from(results[0]["error_mm"]["n"].as_u64().unwrap()).unwrap()
        );
        let known = lines.iter().filter(recorded).all(|line| line["whiskers"][0]["tip_m"][1].is_number());
        assert!(known, "a recorded tip has a place");
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
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--set", "speed=1 mm/s"]);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("the outcome is timeout, expected completed"), "{}", stderr(&output));
    }

    /// A plus, whose inner corners the body cannot follow. The scenario says nothing about its tracing.
    const PLUS: &str = "name: plus
objects:
  - polygon: {vertices: [[0.375 m, 0.1 m], [0.575 m, 0.1 m], [0.575 m, 0.4 m], [0.875 m, 0.4 m], [0.875 m, 0.6 m],
      [0.575 m, 0.6 m], [0.575 m, 0.9 m], [0.375 m, 0.9 m], [0.375 m, 0.6 m], [0.075 m, 0.6 m], [0.075 m, 0.4 m], [0.375 m, 0.4 m]]}
start: {position: [0 m, 72 mm], heading: 90 deg}
stop: {time: 400 s, loop_closed: {within: 5 mm, after: 5 s}}
";

    #[test]
    fn a_loop_around_an_object_that_was_not_traced_has_ended_and_is_not_completed() {
        let out = directory("ended");
        let file = out.join("plus.yaml");
        std::fs::write(&file, PLUS).unwrap();
        let [file, shown] = [&file, &out].map(|path| path.display().to_string());
        let arguments =
            ["run", &file, "--policy", "policies/vibrissa.fsm", "--simulator", "quasistatic", "--out", &shown];
        let output = vibrissa(&arguments);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let (told, table) = (stderr(&output), stdout(&output));
        assert!(told.contains("plus: ended: object_coverage is 6"), "{told}");
        assert_eq!(told.matches("object_coverage").count(), 1, "told once: {told}");
        let text = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
        let result: Value = serde_json::from_str(&text("plus.json")).unwrap();
        assert_eq!((&result["outcome"], result["violations"].as_array().unwrap().len()), (&"ended".into(), 2));
        for text in [table, text("plus.svg"), text("plus.json")] {
            assert!(text.contains("ended") && !text.contains("completed"), "{text:.3000}");
        }
        // The script of a page has all words.
        assert!(text("index.html").contains("ended"));
    }

    #[test]
    fn friction_is_named_where_whiskers_seem_dead() {
        let friction = |rig: &str| {
            let scene = directory("untold_friction").join("scene.yaml");
            let text = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
            std::fs::write(&scene, format!("{text}rig: {rig}\n")).unwrap();
            let output =
                vibrissa(&["run", scene.to_str().unwrap(), "--policy", "vibrissa", "--simulator", "quasistatic"]);
            stderr(&output).lines().filter(|line| line.contains("seems dead")).map(str::to_owned).collect::<Vec<_>>()
        };
        let untold = friction("{physics: {friction: 1}}");
        assert!(!untold.is_empty());
        assert!(
            untold.iter().all(|line| line.contains("the friction of 1, which perception does not assume")),
            "{untold:?}"
        );
        let told = friction("{physics: {friction: 1}, sensing: {friction: 1}}");
        assert!(told.iter().all(|line| line.contains("with which tips stick")), "{told:?}");
    }

    #[test]
    fn a_dead_whisker_is_named_in_the_messages_the_table_and_the_json() {
        let mismatch = directory("dead_whisker").join("dead.yaml");
        std::fs::write(&mismatch, "whiskers: {r0: {sensor: {gain: -90 %}}}\n").unwrap();
        let mismatch = mismatch.display().to_string();
        let arguments = [
            "run",
            "scenarios/round-tunnel.yaml",
            "--policy",
            "policies/vibrissa.fsm",
            "--simulator",
            "quasistatic",
            "--mismatch",
            &mismatch,
            "--uncalibrated",
        ];
        let output = vibrissa(&[&arguments[..], &["--wide"]].concat());
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("warning: r0 seems dead"), "{}", stderr(&output));
        assert!(!stderr(&output).contains("l0 seems dead"), "{}", stderr(&output));
        assert!(!stderr(&output).contains("friction"), "there is none: {}", stderr(&output));
        // The heading `seem dead` has two lines.
        assert!(stdout(&output).contains(" seem ") && stdout(&output).contains(" r0 "), "{}", stdout(&output));
        let output = vibrissa(&[&arguments[..], &["--json"]].concat());
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let dead =
            |index: usize| (&results[0]["whiskers"][index]["whisker"], &results[0]["whiskers"][index]["seems_dead"]);
        assert_eq!((dead(0), dead(1)), ((&"r0".into(), &true.into()), (&"l0".into(), &false.into())));
    }

    #[test]
    fn the_bench_runs_its_scenes_and_reports_them() {
        let out = directory("bench");
        let shown = out.display().to_string();
        let output = vibrissa(&["bench", "--ideal", "--out", &shown, "--json", "--jobs", "2"]);
        let rows: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let rows = rows.as_array().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(rows.len() >= 20 && rows.iter().all(|row| row["outcome"] == "completed" && row["passed"] == true));
        let disk = rows.iter().find(|row| row["scenario"] == "disk").unwrap();
        assert_eq!(
            (&disk["baseline"]["error_mm"]["mean"], &disk["verdicts"]["error_mm"]),
            (&0.8.into(), &"better".into())
        );
        let mut files: Vec<_> =
            out.read_dir().unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        files.sort();
        assert_eq!(files.len(), rows.len() + 2, "{files:?}");
        assert!(files.contains(&"disk-thesis.svg".to_owned()) && files.contains(&"index.html".to_owned()));
        let written = std::fs::read_to_string(out.join("results.json")).unwrap();
        assert_eq!(&serde_json::from_str::<Vec<Value>>(&written).unwrap(), rows);
        let page = std::fs::read_to_string(out.join("index.html")).unwrap();
        assert_eq!(page.matches("<section class=\"run\"").count(), rows.len());
    }

    #[test]
    fn compare_does_the_same_runs_under_every_policy_on_however_many_threads() {
        let compared = |jobs: &str| {
            let disk = "scenarios/disk.yaml";
            let jitter = ["--seeds", "3", "--jitter", "10 mm", "--jitter-heading", "2 deg"];
            let arguments = ["compare", "policies/bang.fsm", "policies/thesis.fsm", disk, "--json", "--jobs", jobs];
            let output = vibrissa(&[&arguments[..], &jitter].concat());
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            let mut document: Value = serde_json::from_str(&stdout(&output)).unwrap();
            // It has the number of threads.
            assert!(document["provenance"].take().is_object());
            document.to_string()
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
        assert!(stderr(&output).contains("all seeds give the same run"), "{}", stderr(&output));
        assert!(stdout(&output).contains("the same"), "{}", stdout(&output));
    }

    #[test]
    fn a_report_is_a_picture_and_the_result() {
        let directory = directory("report");
        let out = directory.join("new").display().to_string();
        // The disk has no retrieval. The strips of an earlier run would seem to belong to this one.
        let strips = directory.join("new/disk.retrievals.svg");
        std::fs::create_dir_all(directory.join("new")).unwrap();
        std::fs::write(&strips, "old").unwrap();
        let output = vibrissa(&["run", "scenarios/disk.yaml", "--out", &out]);
        assert!(!strips.exists());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(stdout(&output).contains("index.html"));
        let picture = std::fs::read_to_string(directory.join("new/disk.svg")).unwrap();
        assert!(picture.starts_with("<svg"));
        let result = std::fs::read_to_string(directory.join("new/disk.json")).unwrap();
        assert!(serde_json::from_str::<Value>(&result).unwrap().is_object());
    }
}

#[cfg(not(feature = "sim"))]
#[test]
fn a_build_without_the_simulator_says_so() {
    let output = vibrissa(&["run", "scenarios/disk.yaml", "--simulator", "mujoco"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("feature `sim`"), "{}", stderr(&output));
}

/// The world of a run's result.
fn world_of(arguments: &[&str]) -> String {
    let output = vibrissa(&[&["run", "--json"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let results: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    results[0]["world"].as_str().unwrap().to_owned()
}

#[test]
fn the_world_is_the_one_asked_for_or_the_scenarios_or_the_one_that_there_is() {
    let disk = "scenarios/disk.yaml";
    assert_eq!(world_of(&[disk, "--simulator", "quasistatic"]), "quasistatic");
    let usual = if cfg!(feature = "sim") { "mujoco" } else { "quasistatic" };
    assert_eq!(world_of(&[disk]), usual);
    let scenario = std::fs::read_to_string(disk).unwrap() + "\nworld: quasistatic\n";
    let path = directory("world").join("disk.yaml");
    std::fs::write(&path, scenario).unwrap();
    assert_eq!(world_of(&[path.to_str().unwrap(), "--policy", "policies/thesis.fsm"]), "quasistatic");
}

#[test]
fn tables_are_at_most_a_hundred_characters_wide_unless_all_columns_are_asked_for() {
    let scenario = directory("wide").join("scene.yaml").display().to_string();
    let disk = std::fs::read_to_string("scenarios/disk.yaml").unwrap();
    let name = "a-disk-whose-name-is-as-long-as-a-name-of-a-scenario-may-be-0000";
    let policy = std::env::current_dir().unwrap().join("policies/thesis.fsm");
    let named = disk.replace("name: disk", &format!("name: {name}"));
    std::fs::write(&scenario, named.replace("../policies/thesis.fsm", policy.to_str().unwrap())).unwrap();
    let commands: [&[&str]; 3] = [
        &["run", &scenario],
        &["families", "convex-corner", "--count", "1"],
        &["compare", "policies/vibrissa.fsm", "policies/thesis.fsm", &scenario],
    ];
    for command in commands {
        let command = [command, &["--simulator", "quasistatic"]].concat();
        let [fitted, wide] = [&[][..], &["--wide"]].map(|columns| stdout(&vibrissa(&[&command[..], columns].concat())));
        assert!(fitted.lines().all(|line| line.chars().count() <= 100), "{fitted}");
        assert!(!wide.contains("--wide") && wide.lines().any(|line| line.chars().count() > 100), "{wide}");
    }
    assert_eq!(vibrissa(&["run", &scenario, "--wide", "--json"]).status.code(), Some(2));
}
