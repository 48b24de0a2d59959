//! The tutorial keeps what it promises: every step compiles, does what its tests say, and is warned of what the text says.

use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::policy::compile_with_warnings;

const PAGE: &str = include_str!("../../docs/tutorial.md");

/// The blocks of the page in a language, in their order.
fn blocks(language: &str) -> Vec<&'static str> {
    let begin = format!("```{language}\n");
    PAGE.split(begin.as_str()).skip(1).map(|behind| behind.split("```").next().unwrap()).collect()
}

#[test]
fn every_step_but_the_one_that_says_so_compiles_without_a_warning() {
    let steps = blocks("fsm");
    assert_eq!(steps.len(), 6);
    let mut told = String::new();
    for (index, step) in steps.into_iter().enumerate() {
        let source = Source::new("mine.fsm", step);
        let warnings = compile_with_warnings(&source).unwrap().warnings;
        assert_eq!(warnings.len(), usize::from(index == 3), "{}", terminal(&source, &warnings, Colour::Plain));
        told += &terminal(&source, &warnings, Colour::Plain);
    }
    for line in blocks("text").concat().lines() {
        assert!(told.contains(line), "{told}");
    }
}

#[cfg(feature = "sim")]
#[test]
fn every_step_passes_its_own_tests() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("tutorial");
    let _ = std::fs::remove_dir_all(&folder);
    for name in ["policies", "scenarios"] {
        std::fs::create_dir_all(folder.join(name)).unwrap();
    }
    let disk = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/disk.yaml");
    std::fs::copy(disk, folder.join("scenarios/disk.yaml")).unwrap();
    for step in blocks("fsm") {
        std::fs::write(folder.join("policies/mine.fsm"), step).unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        let output = command.args(["test", "policies/mine.fsm"]).current_dir(&folder).output().unwrap();
        assert!(output.status.success(), "{step}{}", String::from_utf8_lossy(&output.stderr));
    }
}
