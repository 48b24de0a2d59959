//! Outlines of more pieces than MuJoCo can simulate.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use super::program::{directory, stderr, vibrissa};

/// Writes a scenario with an outline of straight pieces, and returns its path. The outline has three dents of this depth, as a
/// share of the radius.
fn scenario(folder: &Path, pieces: u32, dent: f64) -> PathBuf {
    let corner = |index: u32| {
        let angle = TAU * f64::from(index) / f64::from(pieces);
        let radius = 0.3 * (1.0 + dent * (3.0 * angle).sin());
        format!("{:.9},{:.9}\n", 0.4 + radius * angle.cos(), 0.4 + radius * angle.sin())
    };
    std::fs::write(folder.join("p.csv"), (0..pieces).map(corner).collect::<String>()).unwrap();
    let text = "name: p
objects:
  - outline: {file: p.csv, unit: 1 m}
start: {position: [0 m, 72 mm], heading: 90 deg}
stop: {time: 120 s, loop_closed: {within: 5 mm, after: 5 s}}
";
    let path = folder.join("p.yaml");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn outlines_of_thousands_of_pieces_run_in_the_quasi_static_simulator() {
    for (dent, name) in [(0.0, "many-pieces-convex"), (0.1, "many-pieces-concave")] {
        let folder = directory(name);
        let path = scenario(&folder, 20_000, dent).display().to_string();
        let output = vibrissa(&["run", &path, "--policy", "policies/vibrissa.fsm", "--simulator", "quasistatic"]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
    }
}

#[test]
fn what_mujoco_cannot_simulate_is_refused_with_its_line() {
    let path = scenario(&directory("many-pieces-refused"), 3000, 0.0).display().to_string();
    let refused = |arguments: &[&str], advice: &str| {
        let output = vibrissa(&[arguments, &[&path]].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        let told =
            "in line 3 of the scenario, the object has too many corners for MuJoCo (3000 corners; the limit is 2048)";
        assert!(stderr(&output).contains(told) && stderr(&output).contains(advice), "{}", stderr(&output));
    };
    refused(&["inspect", "mjcf"], "leave out vertices");
    refused(&["inspect", "explain", "--simulator", "mujoco"], "use the simulator `quasistatic`");
    #[cfg(feature = "sim")]
    refused(&["run", "--simulator", "mujoco"], "use the simulator `quasistatic`");
    let output = vibrissa(&["inspect", "explain", "--simulator", "quasistatic", &path]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
