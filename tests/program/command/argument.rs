//! What the program is called with.

use std::process::{Command, Output};

use super::program::{ROOT, bad, directory, stderr, stdout, vibrissa};

#[test]
fn help_explains_every_command() {
    let help = stdout(&vibrissa(&["--help"]));
    for command in
        ["run", "bench", "calibrate", "check", "study", "study stress", "inspect", "inspect mjcf", "setup man"]
    {
        let words: Vec<_> = command.split(' ').collect();
        let is_offered = help.lines().any(|line| line.trim_start().starts_with(&format!("{command} ")));
        assert_eq!(is_offered, words.len() == 1, "{command}");
        let output = vibrissa(&[&words, &["--help"][..]].concat());
        assert_eq!(output.status.code(), Some(0));
        assert!(stdout(&output).contains("Usage:"));
    }
    for heading in ["Write policies:", "Run them:", "Look inside:", "Sensors:", "Robot:"] {
        assert!(help.lines().any(|line| line == heading), "{heading}: {help}");
    }
}

#[test]
fn the_old_name_of_a_command_is_answered_with_the_new_one() {
    for (old, new) in [("diff", "inspect diff"), ("timing", "study timing"), ("services", "setup services")] {
        let output = vibrissa(&[old, "anything"]);
        assert_eq!(output.status.code(), Some(2), "{old}");
        assert!(stderr(&output).contains(&format!("this command is now `vibrissa {new}`")), "{}", stderr(&output));
    }
}

#[test]
fn the_old_name_of_the_simulator_is_accepted_and_the_new_one_is_said() {
    let [old, new] = ["--world=quasistatic", "--simulator=quasistatic"]
        .map(|option| vibrissa(&["run", "disk", "--policy", "thesis", option, "--json"]));
    assert_eq!((old.status.code(), figures(&old)), (new.status.code(), figures(&new)));
    assert!(
        stderr(&old).contains("`--world` is now `--simulator`") && !stderr(&new).contains("--world"),
        "{}",
        stderr(&old)
    );
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

/// A stack that no machine has room for: no thread can be started.
#[test]
fn without_other_threads_all_is_done_by_the_first() {
    let arguments = ["families", "two-objects", "--count", "3", "--simulator", "quasistatic", "--json", "-j", "3"];
    let alone = Command::new(env!("CARGO_BIN_EXE_vibrissa"))
        .args(arguments)
        .env("RUST_MIN_STACK", (1_u64 << 46).to_string())
        .current_dir(ROOT)
        .output()
        .unwrap();
    assert!(stderr(&alone).contains("warning: the system starts no more than 1 at a time"), "{}", stderr(&alone));
    let several = vibrissa(&arguments);
    assert_eq!((alone.status.code(), figures(&alone)), (several.status.code(), figures(&several)));
}

/// How runs ended, and their errors.
fn figures(output: &Output) -> Vec<String> {
    let figures = stdout(output)
        .lines()
        .filter(|line| line.contains("outcome") || line.contains("_mm"))
        .map(str::to_owned)
        .collect();
    assert_ne!(figures, [""; 0]);
    figures
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
        (vec!["run", disk, "--set", "speed=fast"], "`speed` is a number, such as"),
        (
            vec!["run", disk, "--policy", "policies/vibrissa.fsm", "--set", "trust=1"],
            "`trust` is `false` or `true`, not 1",
        ),
        (
            vec!["run", disk, "--policy", "policies/vibrissa.fsm", "--set", "trust=no"],
            "`trust` is `false` or `true`, not `no`",
        ),
        (vec!["run", disk, "--set", "speed=20 mn/s"], "mn"),
        (vec!["run", disk, disk], "have the same name `disk`"),
        (vec!["run"], "SCENARIO"),
        (vec!["fly"], "fly"),
        (vec!["bench", "--policy", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (
            vec!["bench", "--policy", "policies/thesis.fsm", "--policy", "policies/thesis.fsm"],
            "have the same name `thesis`",
        ),
        (vec!["bench", "--set", "trust=1"], "policies/thesis.fsm: the policy has no parameter `trust`"),
        (vec!["families", "--set", "speed=20 mm/s"], "families set the speed"),
        (vec!["sweep", "a.yaml", "-j", "100000000"], "32 for each processor"),
        (vec!["bench", "--friction", "0.1,2"], "from 0 to 1"),
        (vec!["bench", "--friction", "-1"], "from 0 to 1"),
        (vec!["compare", "policies/thesis.fsm"], "1 policy is given; give two or more"),
        (vec!["compare", disk], "0 policies are given"),
        (vec!["compare", "policies/thesis.fsm", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (vec!["compare", "policies/thesis.fsm", "policies/bang.fsm", "a.yaml"], "cannot read a.yaml"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter", "5 deg"], "a length"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter", "-5 mm"], "write a length from 0 to 10 m"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter", "1e300 m"], "write a length from 0 to 10 m"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter-heading", "181 deg"], "write an angle from 0 to 180 deg"),
        (vec!["compare", "a.fsm", "b.fsm", "--jitter", "10 m", "--jitter-heading", "180 deg"], "cannot read a.fsm"),
        (vec!["fmt"], "POLICY"),
        (vec!["fmt", "policies/nothing.fsm"], "cannot read policies/nothing.fsm"),
        (vec!["inspect", "mjcf", "policies/thesis.fsm"], "policies/thesis.fsm:"),
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
fn every_count_is_refused_with_its_range_which_the_help_states() {
    for (command, count, range) in [
        ("study timing", "--repeats", "from 1 to 1000"),
        ("study scale", "--repeats", "from 1 to 1000"),
        ("bench", "--jobs", "from 1 to "),
        ("study pareto", "--repeats", "from 1 to 1000"),
        ("compare", "--seeds", "from 1 to 100000"),
        ("compare", "-j", "from 1 to "),
        ("families", "--count", "from 1 to 100000"),
        ("sweep", "-j", "from 1 to "),
        ("study stress", "--jobs", "from 1 to "),
        ("graph", "--depth", "from 1 to 8"),
    ] {
        let words: Vec<_> = command.split(' ').collect();
        let help =
            stdout(&vibrissa(&[&words, &["--help"][..]].concat())).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(help.contains(range), "{command} {count}: {help}");
        for value in ["0", "-1", "1.5", "some", "", "18446744073709551615", "18446744073709551616"] {
            let output = vibrissa(&[&words, &[count, value][..]].concat());
            let told = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{command} {count} {value}: {told}");
            assert!(told.contains(&format!("write a whole number {range}")), "{command} {count} {value}: {told}");
        }
    }
    for (command, number) in
        [("run", "--seed"), ("families", "--seed"), ("families", "--trial"), ("calibrate", "--seed")]
    {
        for value in ["-1", "1.5", "18446744073709551616"] {
            let told = stderr(&vibrissa(&[command, number, value]));
            let range = "write a whole number from 0 to 18446744073709551615";
            assert!(told.contains(range), "{command} {number} {value}: {told}");
        }
    }
}

#[test]
fn every_command_that_writes_takes_the_place_alike() {
    for command in ["run", "bench", "compile", "graph"] {
        assert!(stdout(&vibrissa(&[command, "--help"])).contains("-o, --out <"), "{command}");
    }
}

#[test]
fn a_file_without_end_or_of_another_kind_is_refused_with_its_name_and_exit_status_2() {
    for (file, expected) in [
        ("/dev/zero", "it is a device"),
        ("tests/fixtures/latin1.txt", "the byte 0xB5 in line 1, column 20 is invalid"),
    ] {
        for arguments in [vec!["check", file], vec!["inspect", "mjcf", file], vec!["run", file]] {
            let output = vibrissa(&arguments);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}");
            let message = stderr(&output);
            assert!(message.contains(&format!("cannot read {file}")) && message.contains(expected), "{message}");
        }
    }
}

#[test]
fn another_name_is_suggested_only_where_there_is_no_file() {
    let directory = directory("suggested-names");
    std::fs::write(directory.join("laws.fsm"), "library laws\n").unwrap();
    let policy = |used: &str| {
        let text = format!("machine m\nuse \"{used}\"\ninitial S\nstate S {{ after 1 s -> Failure(\"late\") }}\n");
        std::fs::write(directory.join("policy.fsm"), text).unwrap();
        stderr(&vibrissa(&["check", directory.join("policy.fsm").to_str().unwrap()]))
    };
    let absent = policy("lews.fsm");
    assert!(absent.contains("did you mean `laws.fsm`?"), "{absent}");
    std::fs::write(directory.join("lews.fsm"), b"library lews\n# \xb5m\n").unwrap();
    let present = policy("lews.fsm");
    assert!(present.contains("the byte 0xB5 in line 2, column 3") && !present.contains("did you mean"), "{present}");
}

#[cfg(not(feature = "lsp"))]
#[test]
fn a_build_without_the_language_server_says_how_to_get_it() {
    let output = vibrissa(&["lsp"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--features lsp"), "{}", stderr(&output));
}
