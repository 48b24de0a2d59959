//! `vibrissa graph` and `vibrissa inspect mjcf`

use super::program::{directory, stderr, stdout, vibrissa};

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
    let output = vibrissa(&["inspect", "mjcf", "scenarios/disk.yaml"]);
    assert_eq!(output.status.code(), Some(0));
    let model = stdout(&output);
    assert!(model.starts_with("<mujoco") && model.contains(r#"type="cylinder""#));
}

#[test]
fn graph_shows_a_part_of_a_statechart() {
    for format in ["svg", "mermaid", "dot"] {
        let shown = |arguments: &[&str]| {
            let output = vibrissa(&[&["graph", "policies/vibrissa.fsm", "--format", format], arguments].concat());
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            stdout(&output)
        };
        let outermost = shown(&["--depth", "1"]);
        assert!(outermost.contains("Retrieving") && !outermost.contains("Springing"), "{outermost}");
        let one = shown(&["--state", "Retrieving", "--depth", "1"]);
        assert!(one.contains("Springing") && !one.contains("Exploring"), "{one}");
    }
    for (arguments, is_told) in [(&[][..], true), (&["--depth", "1"], false)] {
        let output = vibrissa(&[&["graph", "policies/vibrissa.fsm"], arguments].concat());
        assert_eq!(stderr(&output).contains("`--depth 1` shows the outermost"), is_told, "{}", stderr(&output));
    }
    let output = vibrissa(&["graph", "policies/vibrissa.fsm", "--state", "Retreiving"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("do you mean `Retrieving`?"), "{}", stderr(&output));
}
