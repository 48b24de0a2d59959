//! The disk under `thesis.fsm`, and variations of it.

use std::path::Path;
use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::policy::compile;
use vibrissa::run::Run;
use vibrissa::scenario;
use vibrissa::scene::{Outcome, Scene, WorldKind};
use vibrissa::score::Score;
use vibrissa::trial::Trial;
use vibrissa_runtime::machine::Program;

fn read(name: &str) -> Source {
    Source::new(name, std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap())
}

fn scene(text: &str) -> Scene {
    scenario::read(&Source::new("scene.yaml", text)).unwrap()
}

fn thesis() -> Program {
    compile(&read("policies/thesis.fsm")).unwrap()
}

fn run(scene: &Scene, program: Program, seed: u64) -> (Run, Score) {
    let trial = Trial::new(scene.clone(), Arc::new(program));
    let result = Trial { world: WorldKind::Mujoco.into(), seed, ..trial }.run().unwrap();
    (result.run, result.score)
}

#[test]
fn the_same_seed_gives_the_same_trace_bit_for_bit() {
    let mut scene = scene(&read("scenarios/disk.yaml").text);
    scene.rig.sensing.angle_noise = 1e-6;
    let first = run(&scene, thesis(), 7).0.trace;
    assert_eq!(first, run(&scene, thesis(), 7).0.trace);
    assert_ne!(first, run(&scene, thesis(), 8).0.trace);
    assert!(first.tips(0).count() > 1000, "the trace holds a contour to compare");
}

/// The world has no left or right of its own: in the mirror the left whisker does what the right one did.
#[test]
fn the_mirrored_scene_gives_the_mirrored_run() {
    let text = read("scenarios/disk.yaml").text;
    let (right, right_score) = run(&scene(&text), thesis(), 0);
    let (left, left_score) = run(&scene(&text.replace("[0.4 m, 0.4 m]", "[-0.4 m, 0.4 m]")), thesis(), 0);
    assert_eq!(right.outcome, Outcome::Completed);
    assert_eq!(left.outcome, Outcome::Completed);
    assert_eq!(right.trace.tips(1).count() + left.trace.tips(0).count(), 0);
    let (right, left) = (right_score.error.unwrap(), left_score.error.unwrap());
    assert!((right.mean - left.mean).abs() < 1e-6, "{} m and {} m", right.mean, left.mean);
}

#[test]
fn the_policy_follows_disks_of_other_sizes_at_other_speeds() {
    for (radius, centre_x, speed) in [(0.15, 0.25, 0.05), (0.6, 0.7, 0.05), (0.3, 0.4, 0.02), (0.3, 0.4, 0.1)] {
        let text = read("scenarios/disk.yaml").text;
        let text = text.replace("[0.4 m, 0.4 m], radius: 0.3 m", &format!("[{centre_x} m, 0.4 m], radius: {radius} m"));
        let text = text.replace("time: 120 s", "time: 300 s");
        let mut program = thesis();
        program.set("speed", speed, vibrissa_runtime::units::Dimension::SPEED).unwrap();
        let (run, score) = run(&scene(&text), program, 0);
        let what = format!("radius {radius} m at {speed} m/s: {:?}", run.reason);
        assert_eq!(run.outcome, Outcome::Completed, "{what}");
        let mean = score.error.unwrap().mean;
        assert!(mean < 0.8e-3, "{what}: mean error {mean} m");
        assert!(score.coverage > 0.9, "{what}: coverage {}", score.coverage);
    }
}

/// A minimal policy: base angle alone, and two commands.
#[test]
fn bang_bang_following_goes_round_too() {
    let program = compile(&read("policies/bang.fsm")).unwrap();
    let (run, score) = run(&scene(&read("scenarios/disk.yaml").text), program, 0);
    assert_eq!(run.outcome, Outcome::Completed, "{:?}", run.reason);
    let mean = score.error.unwrap().mean;
    assert!(mean < 0.8e-3 && score.coverage > 0.95, "mean error {mean} m, coverage {}", score.coverage);
}

#[test]
fn a_policy_that_loses_the_object_fails_and_says_why() {
    let mut program = thesis();
    for name in ["limit", "target"] {
        let parameter = program.parameters.iter().find(|parameter| parameter.name == name).unwrap();
        let (least, most) = parameter.range.unwrap();
        program
            .set(name, if name == "limit" { least } else { most }, vibrissa_runtime::units::Dimension::ANGLE)
            .unwrap();
    }
    let (run, _) = run(&scene(&read("scenarios/disk.yaml").text), program, 0);
    assert_eq!(run.outcome, Outcome::Failed);
    assert_eq!(run.reason.as_deref(), Some("a whisker at its limit"));
    assert_eq!(run.final_state, "Failure");
}

#[test]
fn a_run_that_gets_nowhere_fails_and_says_so() {
    let text = read("scenarios/disk.yaml").text.replace("stop:\n", "stop:\n  stalled: {after: 3 s}\n");
    let still = "machine still whisker r0 initial Still state Still { stop }";
    let (run, _) = run(&scene(&text), compile(&Source::new("still.fsm", still)).unwrap(), 0);
    assert_eq!(run.outcome, Outcome::Failed);
    assert!(run.reason.unwrap().starts_with("no progress for 3 s"));
    assert!((run.trace.ticks.last().unwrap().time - 3.0).abs() < 0.1);
}

#[test]
fn a_run_is_completed_where_the_platform_is_to_get_to() {
    let reaching = |place: &str, time: &str| {
        let reached = format!("reached: {{place: {place}, within: 5 mm, after: 500 ms}}");
        let text = read("scenarios/disk.yaml").text.replace("loop_closed: {within: 5 mm, after: 5 s}", &reached);
        run(&scene(&text.replace("time: 120 s", time)), thesis(), 0).0
    };
    let there = reaching("[0 m, 0.12 m]", "time: 120 s");
    assert_eq!(there.outcome, Outcome::Completed);
    let end = there.trace.ticks.last().unwrap();
    assert!((end.body.position.y - 0.12).abs() <= 0.005 && end.time >= 0.5);
    let elsewhere = reaching("[5 m, 0 m]", "time: 2 s");
    assert_eq!(elsewhere.outcome, Outcome::Timeout);
    assert_eq!(elsewhere.reason.as_deref(), Some("the position was not reached within 2 s"));
}

#[test]
fn a_run_is_completed_when_the_tunnel_is_passed_from_either_end() {
    let tunnel = "objects: [{tunnel: {frame: {position: [0 m, 0.2 m], heading: 90 deg}, centre_line: {mitred: [{length: 40 cm, heading: 0 deg}]}, \
        width: 60 cm, thickness: 2 cm}}]";
    let driving = |start: &str, time: &str| {
        let scenario =
            format!("name: passage\n{tunnel}\nstart: {{position: {start}}}\nstop: {{time: {time}, passed: 90 %}}\n");
        let policy =
            "machine on initial On state On { steer body along direction(body.yaw) at 100 mm/s turning 0 deg/s }";
        run(&scene(&scenario), compile(&Source::new("on.fsm", policy)).unwrap(), 0).0
    };
    for start in ["[0 m, 0 m], heading: 90 deg", "[0 m, 0.8 m], heading: -90 deg"] {
        let there = driving(start, "20 s");
        assert_eq!(there.outcome, Outcome::Completed, "{start}");
        // The share of the axis from 0.2 m to 0.6 m, to the next tick.
        let y = there.trace.ticks.last().unwrap().body.position.y;
        let passed = if start.contains("-90") { 0.6 - y } else { y - 0.2 };
        assert!((0.36..0.37).contains(&passed), "{start}: {passed} m");
    }
    let beside = driving("[0.5 m, 0 m], heading: 90 deg", "8 s");
    assert_eq!(beside.outcome, Outcome::Timeout);
    assert_eq!(beside.reason.as_deref(), Some("the tunnel was not passed within 8 s"));
}

#[test]
fn a_run_whose_policy_has_to_succeed_is_complete_when_it_does() {
    let text = read("scenarios/disk.yaml").text.replace("loop_closed: {within: 5 mm, after: 5 s}", "succeeded: true");
    let scene = scene(&text.replace("time: 120 s", "time: 2 s"));
    let ends = |duration: &str| {
        let policy = format!(r#"machine m initial Still state Still {{ stop after {duration} -> Success("done") }}"#);
        run(&scene, compile(&Source::new("m.fsm", &policy)).unwrap(), 0).0
    };
    let (in_time, too_late) = (ends("1 s"), ends("3 s"));
    assert_eq!((in_time.outcome, in_time.reason.as_deref()), (Outcome::Completed, Some("done")));
    assert_eq!(too_late.outcome, Outcome::Timeout);
    assert_eq!(too_late.reason.as_deref(), Some("the policy did not end in `Success` within 2 s"));
}
