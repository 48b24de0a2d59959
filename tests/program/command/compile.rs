//! `vibrissa compile`

use std::path::Path;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

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
    let (as_text, empty) = (file("as_text.machine"), file("empty.machine"));
    assert_eq!(vibrissa(&["compile", "policies/thesis.fsm", "-o", &machine]).status.code(), Some(0));
    let mut bytes = std::fs::read(&machine).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() - 1]).unwrap();
    std::fs::write(&as_text, String::from_utf8_lossy(&bytes).replace("\r\n", "\n")).unwrap();
    std::fs::write(&empty, "").unwrap();
    bytes[100] ^= 1;
    std::fs::write(&damaged, &bytes).unwrap();
    let bad = "tests/fixtures/policies/bad/name_unknown.fsm";
    for (arguments, expected) in [
        (vec!["check", &damaged], "is damaged"),
        (vec!["check", &cut], "truncated"),
        (vec!["check", &as_text], "a copy in text mode"),
        (vec!["run", "scenarios/disk.yaml", "--policy", &empty], "does not begin as compiled machines do"),
        (vec!["run", "scenarios/disk.yaml", "--policy", &damaged], "is damaged"),
        (vec!["compile", bad, "-o", &cut], "P0201"),
        (vec!["compile", "policies/thesis.fsm", "-o", &cut, "--set", "speed=2 m/s"], "must lie between"),
        (vec!["compile", "policies/thesis.fsm"], "--out"),
        (
            vec!["compile", "policies/thesis.fsm", "-o", "policies/thesis.fsm"],
            "this command reads it as policies/thesis.fsm",
        ),
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
fn the_ending_of_a_file_decides_the_format_of_a_statechart() {
    let folder = directory("chart_files");
    let graph = |name: &str, more: &[&str]| {
        let path = folder.join(name);
        let arguments = ["graph", "policies/bang.fsm", "-o", path.to_str().unwrap()];
        let output = vibrissa(&[&arguments, more].concat());
        (output.status.code(), std::fs::read_to_string(&path).unwrap_or_default(), stderr(&output))
    };
    for (name, more, begin) in [
        ("a.svg", &[][..], "<svg"),
        ("chart", &[], "<svg"),
        ("a.dot", &[], "digraph"),
        ("a.gv", &[], "digraph"),
        ("a.mmd", &[], "stateDiagram"),
        ("a.txt", &["--format", "dot"], "digraph"),
    ] {
        let (status, text, message) = graph(name, more);
        assert_eq!(status, Some(0), "{name}: {message}");
        assert!(text.contains(begin), "{name}: {text}");
    }
    for name in ["m.png", "m.pdf", "m.SVG"] {
        let (status, text, message) = graph(name, &[]);
        assert_eq!((status, text.as_str()), (Some(2), ""), "{name}");
        assert!(message.contains(name) && message.contains(".svg, .mmd or .dot"), "{message}");
    }
}
