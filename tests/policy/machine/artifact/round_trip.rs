//! What goes in comes out.

use vibrissa_language::compile;
use vibrissa_runtime::machine::{Artifact, MAGIC};
use vibrissa_runtime::units::Dimension;

use super::{erratic, policies};

#[test]
fn every_policy_comes_back_as_it_was_and_runs() {
    for artifact in policies::all() {
        let bytes = artifact.to_bytes().unwrap();
        let back = Artifact::from_bytes(&bytes).unwrap();
        assert_eq!(back, artifact);
        assert_eq!(back.to_bytes().unwrap(), bytes);
        erratic::run(back.program);
    }
}

#[test]
fn the_same_text_gives_the_same_bytes_wherever_its_file_lies() {
    let bytes = |name| policies::artifact(name, policies::EVERYTHING).to_bytes().unwrap();
    assert_eq!(bytes("a/b/everything.fsm"), bytes("everything.fsm"));
    assert_eq!(bytes(r"C:\everything.fsm"), bytes("everything.fsm"));
    assert_ne!(bytes("other.fsm"), bytes("everything.fsm"));
}

#[test]
fn the_program_is_the_one_that_compiling_gives() {
    let source = vibrissa_text::diagnostic::Source::new("everything.fsm", policies::EVERYTHING);
    assert_eq!(compile(&source).unwrap(), policies::everything().program);
}

#[test]
fn a_parameter_that_was_set_stays_set() {
    let mut artifact = policies::everything();
    artifact.program.set("fast", 0.1, Dimension::SPEED).unwrap();
    let back = Artifact::from_bytes(&artifact.to_bytes().unwrap()).unwrap();
    assert_eq!(back.program.initial_registers.first(), Some(&0.1));
    assert_ne!(back, policies::everything());
}

#[test]
fn the_source_map_leads_to_names_and_conditions() {
    let text = "machine m whisker w initial A\n\n  state A {\n when w.touching -> B  after 1 s -> A }\nstate B { stop }\n\
                always when time > 9 s -> B";
    let artifact = policies::artifact("m.fsm", text);
    let place = |position: vibrissa_text::diagnostic::Position| (position.line, position.column);
    let states: Vec<_> = artifact.positions.states.iter().map(|state| place(state.name)).collect();
    assert_eq!(states, [(3, 9), (5, 7)]);
    assert_eq!(
        artifact.positions.states[0].transitions.iter().copied().map(place).collect::<Vec<_>>(),
        [(4, 7), (4, 30)]
    );
    assert_eq!(artifact.positions.always.iter().copied().map(place).collect::<Vec<_>>(), [(6, 13)]);
}

#[test]
fn no_policy_begins_like_an_artifact() {
    assert!(std::str::from_utf8(&MAGIC).is_err());
    assert!(!Artifact::is_in(policies::EVERYTHING.as_bytes()));
    assert!(Artifact::is_in(&policies::everything().to_bytes().unwrap()));
}

#[test]
fn the_origin_names_file_text_and_compiler() {
    let origin = policies::artifact("somewhere/empty.fsm", "machine m initial S state S { }").origin;
    assert_eq!((origin.file.as_str(), origin.compiler.as_str()), ("empty.fsm", env!("CARGO_PKG_VERSION")));
    assert_ne!(origin.text_sha256, policies::everything().origin.text_sha256);
}

#[test]
fn what_is_said_of_a_parameter_comes_along() {
    let text = "machine m initial S param p = 1  # how  much\n# how far\nparam q = 2 m\nstate S { stop }";
    let artifact = policies::artifact("m.fsm", text);
    let back = Artifact::from_bytes(&artifact.to_bytes().unwrap()).unwrap();
    let said: Vec<&str> = back.program.parameters.iter().map(|parameter| parameter.description.as_str()).collect();
    assert_eq!(said, ["how much", "how far"]);
}
