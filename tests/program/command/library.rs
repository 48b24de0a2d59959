//! The program where MuJoCo's library, or its plugin, cannot be had.

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::program::{directory, stderr, stdout};

/// The directory in which the program looks for MuJoCo's library; a MuJoCo of the system is where the loader finds it.
const LIBRARIES: Option<&str> = option_env!("MUJOCO_DYNAMIC_LINK_DIR");

/// A policy that stands still for as long as its scene lasts.
const BRIEF: &str = "machine brief\n\nwhisker r0\n\ninitial Still\n\nstate Still {\n  record r0\n  stop\n  after 60 s -> Failure(\"late\")\n}\n";
const SCENE: &str = "name: brief\nobjects:\n  - circle: {centre: [0.4 m, 0.4 m], radius: 0.3 m}\n\
                     start: {position: [0 m, 72 mm], heading: 90 deg}\nstop: {time: 1 s}\npolicy: brief.fsm\n";

/// A directory with a scene, and a copy of the program that looks for libraries in the `lib` that may be there.
fn elsewhere(name: &str) -> Option<PathBuf> {
    let libraries = LIBRARIES?;
    let directory = directory(name);
    let mut program = std::fs::read(env!("CARGO_BIN_EXE_vibrissa")).unwrap();
    // As long as the other, for places in the file stay what they are.
    let moved = format!("lib{}", "/".repeat(libraries.len() - 3));
    let places: Vec<usize> = (0..program.len()).filter(|&at| program[at..].starts_with(libraries.as_bytes())).collect();
    for place in &places {
        program[*place..*place + moved.len()].copy_from_slice(moved.as_bytes());
    }
    assert!(!places.is_empty());
    std::fs::write(directory.join("vibrissa"), program).unwrap();
    let executable = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    std::fs::set_permissions(directory.join("vibrissa"), executable).unwrap();
    std::fs::write(directory.join("brief.fsm"), BRIEF).unwrap();
    std::fs::write(directory.join("scene.yaml"), SCENE).unwrap();
    std::fs::write(directory.join("cable.yaml"), format!("{SCENE}rig: {{preset: peer_cable}}\n")).unwrap();
    Some(directory)
}

fn run(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(directory.join("vibrissa"));
    command.args(arguments).current_dir(directory).env_remove("LD_LIBRARY_PATH").output().unwrap()
}

#[test]
fn without_mujocos_library_all_works_that_does_not_need_it_and_the_rest_says_what_to_do() {
    let Some(directory) = elsewhere("no-library") else { return };
    for arguments in [&["check", "brief.fsm"][..], &["fmt", "--check", "brief.fsm"], &["inspect", "mjcf", "scene.yaml"]]
    {
        let output = run(&directory, arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    }
    let output = run(&directory, &["run", "scene.yaml", "--simulator", "quasistatic", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("\"outcome\": \"completed\""), "{}", stdout(&output));
    for arguments in
        [&["run", "scene.yaml"][..], &["run", "cable.yaml"], &["study", "stress"], &["bench"], &["calibrate"]]
    {
        let output = run(&directory, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        let told = stderr(&output);
        for wanted in ["error: ", "libmujoco", "cargo x setup", "quasistatic"] {
            assert!(told.contains(wanted), "{arguments:?}: {wanted}: {told}");
        }
        assert!(told.lines().filter(|line| line.contains("error: ")).count() == 1, "{told}");
    }
}

#[test]
fn a_damaged_library_or_plugin_is_told_with_what_to_do() {
    let Some(directory) = elsewhere("damaged-library") else { return };
    let libraries = Path::new(LIBRARIES.unwrap());
    let lib = directory.join("lib");
    std::fs::create_dir(&lib).unwrap();
    let mut names = std::fs::read_dir(libraries).unwrap().map(|entry| entry.unwrap().file_name());
    let name = names.find(|name| name.to_string_lossy().starts_with("libmujoco.so.")).unwrap();
    let told_by = |scene: &str| {
        let output = run(&directory, &["run", scene]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        let told = stderr(&output);
        assert!(told.contains("cargo x setup"), "{told}");
        told
    };
    std::fs::write(lib.join(&name), "no library").unwrap();
    assert!(told_by("scene.yaml").contains("MuJoCo's library cannot be loaded"));
    std::fs::remove_file(lib.join(&name)).unwrap();
    symlink(libraries.join(&name), lib.join(&name)).unwrap();
    assert!(told_by("cable.yaml").contains("MuJoCo's cable plugin is missing"));
    std::fs::write(lib.join("libelasticity.so"), "no plugin").unwrap();
    assert!(told_by("cable.yaml").contains("MuJoCo's cable plugin cannot be loaded"));
    let output = run(&directory, &["run", "scene.yaml"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

/// A library with nothing but MuJoCo's function for its version, and the answer of a version that this program does not use.
const OTHER_VERSION: &str = "int mj_version(void) { return 4000000; }\n";

#[test]
fn another_version_of_the_library_is_refused_by_every_command_that_loads_it() {
    let Some(directory) = elsewhere("other-version") else { return };
    let libraries = Path::new(LIBRARIES.unwrap());
    let mut names = std::fs::read_dir(libraries).unwrap().map(|entry| entry.unwrap().file_name());
    let name = names.find(|name| name.to_string_lossy().starts_with("libmujoco.so.")).unwrap();
    let source = directory.join("other.c");
    std::fs::write(&source, OTHER_VERSION).unwrap();
    // Beside the program, as in a release.
    let library = directory.join(name);
    let compiled = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(&source).status().unwrap();
    assert!(compiled.success());
    for arguments in [&["run", "scene.yaml"][..], &["study", "stress"], &["bench"], &["calibrate"]] {
        let output = run(&directory, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        let told = stderr(&output);
        for wanted in ["error: ", "MuJoCo 3.17.0 is needed", "libmujoco.so", "is MuJoCo 4.0.0", "quasistatic"] {
            assert!(told.contains(wanted), "{arguments:?}: {wanted}: {told}");
        }
    }
    let output = run(&directory, &["run", "scene.yaml", "--simulator", "quasistatic"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
