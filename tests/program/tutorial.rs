//! The tutorial and the page about several objects keep what they promise: every policy compiles, does what its tests say, and
//! is warned of what the text says.

use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::policy::compile_with_warnings;

const LANGUAGE: &str = include_str!("../../docs/language.md");
const TUTORIAL: &str = include_str!("../../docs/tutorial.md");
#[cfg(feature = "sim")]
const SEVERAL_OBJECTS: &str = include_str!("../../docs/howto/several-objects.md");

/// The blocks of a page in a language, in their order.
fn blocks(page: &'static str, language: &str) -> Vec<&'static str> {
    let begin = format!("```{language}\n");
    page.split(begin.as_str()).skip(1).map(|behind| behind.split("```").next().unwrap()).collect()
}

#[test]
fn every_step_but_the_one_that_says_so_compiles_without_a_warning() {
    let steps = blocks(TUTORIAL, "fsm");
    assert_eq!(steps.len(), 7);
    let mut told = String::new();
    for (index, step) in steps.into_iter().enumerate() {
        let source = Source::new("mine.fsm", step);
        let warnings = compile_with_warnings(&source).unwrap().warnings;
        assert_eq!(warnings.len(), usize::from(index == 3), "{}", terminal(&source, &warnings, Colour::Plain));
        told += &terminal(&source, &warnings, Colour::Plain);
    }
    for line in blocks(TUTORIAL, "text").concat().lines() {
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
    for scenario in ["scenarios/disk.yaml", "scenarios/box.yaml"] {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(scenario);
        std::fs::copy(file, folder.join(scenario)).unwrap();
    }
    for step in blocks(TUTORIAL, "fsm") {
        std::fs::write(folder.join("policies/mine.fsm"), step).unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        let output = command.args(["test", "policies/mine.fsm"]).current_dir(&folder).output().unwrap();
        assert!(output.status.success(), "{step}{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[cfg(feature = "sim")]
#[test]
fn the_policy_for_several_objects_traces_them_in_both_worlds() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("several");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("mine.fsm"), blocks(SEVERAL_OBJECTS, "fsm").concat()).unwrap();
    std::fs::write(folder.join("mine.yaml"), blocks(SEVERAL_OBJECTS, "yaml").concat()).unwrap();
    for arguments in [&["test", "mine.fsm"][..], &["run", "mine.yaml", "--simulator", "quasistatic"]] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa"))
            .args(arguments)
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// A direction that is not known yet makes a command that is not finite, which ends the run.
#[test]
fn every_machine_of_the_tour_of_the_language_drives_the_disk_with_finite_commands() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("tour");
    std::fs::create_dir_all(&folder).unwrap();
    let machines =
        blocks(LANGUAGE, "fsm").into_iter().filter(|block| block.starts_with("machine") && !block.contains("test \""));
    let mut runs = 0;
    for (index, machine) in machines.enumerate() {
        let policy = folder.join(format!("{index}.fsm"));
        std::fs::write(&policy, machine).unwrap();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa"))
            .args(["run", "disk", "--simulator", "quasistatic", "--json", "--policy"])
            .arg(&policy)
            .output()
            .unwrap();
        let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let reason = result[0]["reason"].as_str().unwrap_or_default();
        assert!(result[0]["outcome"].is_string() && !reason.contains("not finite"), "{reason}: {machine}");
        runs += 1;
    }
    assert!(runs > 8);
}
