//! What is told of what is left out of a run.

use vibrissa::diagnostic::Source;
use vibrissa::physics::Preset;
use vibrissa::scenario;
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::trial;
use vibrissa::world::{Pruning, Verdict};

use crate::snapshots::snapshots;

fn scene(name: &str) -> Scene {
    let path = format!("{}/scenarios/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    scenario::read(&Source::new(name, std::fs::read_to_string(path).unwrap())).unwrap()
}

fn pruning(scene: &Scene, bound: &[&str], world: WorldKind) -> Pruning {
    let bound: Vec<String> = bound.iter().map(ToString::to_string).collect();
    trial::pruning(scene, &scene.rig, &scene.physics, &bound, world).unwrap()
}

#[test]
fn every_decision_is_told_with_what_it_saves_and_why_it_is_safe() {
    let (one_part, many_parts) = (scene("box"), scene("round-tunnel"));
    snapshots("explain").bind(|| {
        insta::assert_snapshot!("box", pruning(&one_part, &["r0"], WorldKind::Mujoco));
        insta::assert_snapshot!("round_tunnel", pruning(&many_parts, &["r0", "l0"], WorldKind::Mujoco));
    });
}

#[test]
fn a_whisker_that_no_policy_binds_stays_because_it_pushes() {
    let scene = scene("disk");
    for world in WorldKind::ALL {
        let kept = |bound: &[&str]| {
            let decisions = pruning(&scene, bound, world).decisions;
            decisions.iter().filter(|one| one.verdict == Verdict::Kept && one.subject.contains("whisker")).count()
        };
        assert_eq!((kept(&["r0", "l0"]), kept(&["r0"])), (0, 1));
    }
}

#[test]
fn what_is_left_out_saves_something_and_what_stays_does_not() {
    for decision in pruning(&scene("zigzag-tunnel"), &["l0"], WorldKind::Mujoco).decisions {
        assert_eq!(decision.saves.is_some(), decision.verdict != Verdict::Kept, "{decision:?}");
    }
}

#[test]
fn a_rigid_cable_saves_three_degrees_of_freedom_a_ball_joint() {
    let mut scene = scene("disk");
    Preset::PeerCable.apply(&mut scene.rig, &mut scene.physics);
    let told = pruning(&scene, &["r0", "l0"], WorldKind::Mujoco).to_string();
    // Two whiskers with a hinge and 39 ball joints each, and a platform.
    assert!(told.contains("236 of 239 degrees of freedom"), "{told}");
}
