//! What is left out of a run changes nothing.

use std::sync::Arc;

use vibrissa::built_in::POLICIES;
use vibrissa::diagnostic::Source;
use vibrissa::family::{Draw, FAMILIES};
use vibrissa::geometry::{Point2, Pose};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::policy::{compile, gather};
use vibrissa::run::{Run, TickRecord};
use vibrissa::scenario;
use vibrissa::scene::{Scene, WorldKind, WorldSetup};
use vibrissa::trial::{Trial, in_parallel, processors};
use vibrissa::world::World;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::units::Dimension;

fn thesis() -> Program {
    let source = Source::new(POLICIES[0].path, POLICIES[0].text);
    compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap()
}

fn run(scene: &Scene, program: &Program, world: WorldSetup) -> Run {
    Trial { world, ..Trial::new(scene.clone(), Arc::new(program.clone())) }.run().unwrap().run
}

/// All points of the estimated contours of a run, in the order in which they were recorded.
fn contour(scene: &Scene, program: &Program, prune: bool) -> Vec<Point2> {
    let world = WorldSetup { kind: WorldKind::Mujoco, prune };
    let run = run(scene, program, world);
    run.trace.ticks.iter().flat_map(TickRecord::tips).collect()
}

/// Runs that many scenes of every family for so long (s), with and without; how many points there were.
fn compare(trials: u64, time: f64) -> usize {
    let policy = thesis();
    let families = FAMILIES;
    let keys: Vec<_> = families.iter().flat_map(|family| (0..trials).map(move |trial| (family, trial))).collect();
    let counts = in_parallel(
        &keys,
        processors(),
        |(family, trial)| {
            let Draw { mut scene, speed, .. } = family.draw(8, *trial).unwrap();
            scene.stop.time = time;
            let mut program = policy.clone();
            program.set("speed", speed, Dimension::SPEED).unwrap();
            let [pruned, whole] = [true, false].map(|prune| contour(&scene, &program, prune));
            assert_eq!(pruned.len(), whole.len(), "{}", scene.name);
            for (a, b) in pruned.iter().zip(&whole) {
                assert!([a.x, a.y].map(f64::to_bits) == [b.x, b.y].map(f64::to_bits), "{}: {a} and {b}", scene.name);
            }
            pruned.len()
        },
        |_| (),
    );
    counts.into_iter().sum()
}

#[test]
fn pruning_does_not_change_the_estimated_contour() {
    assert!(compare(1, 12.0) > 100);
}

#[test]
#[ignore = "takes minutes; `cargo test --release --test simulators pruning -- --ignored` runs it"]
fn pruning_does_not_change_the_estimated_contour_of_hundreds_of_scenes() {
    assert!(compare(30, 20.0) > 10_000);
}

/// The bits of everything that is sensed while a platform goes as `program` has it go with pruning, with and without pruning.
fn sensed(scene: &Scene, program: &Program) -> [Vec<u64>; 2] {
    let run = run(scene, program, WorldKind::Mujoco.into());
    let commands: Vec<_> = run.trace.ticks.iter().map(|tick| tick.command).collect();
    assert!(commands.len() > 100, "{}: {} ticks", scene.name, commands.len());
    [MujocoWorld::pruned, MujocoWorld::new].map(|build| {
        let mut world = build(&scene.rig, &scene.physics, &scene.solids, scene.start, scene.seed).unwrap();
        let mut sensed = Vec::new();
        for sample in commands.iter().flat_map(|command| world.advance(command).unwrap().to_vec()) {
            let Pose { position, heading } = sample.body;
            sensed.extend([position.x, position.y, heading].map(f64::to_bits));
            for whisker in sample.whiskers {
                let forces = [whisker.axial, whisker.shear].map(Option::unwrap_or_default);
                sensed.extend(forces.into_iter().chain([whisker.base_angle]).map(f64::to_bits));
            }
        }
        sensed
    })
}

#[test]
fn pruning_changes_no_bit_of_what_is_sensed() {
    let policy = thesis();
    let cases = [
        ("disk", true, 0.0, 8.0),
        ("complex", true, 0.0, 12.0),
        ("complex", false, 0.3, 12.0),
        ("box", true, 0.3, 8.0),
        ("round-tunnel", true, 0.0, 20.0),
        ("zigzag-tunnel", true, 0.3, 8.0),
    ];
    in_parallel(
        &cases,
        processors(),
        |(name, forces, friction, time)| {
            let path = format!("{}/scenarios/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
            let mut scene = scenario::read(&Source::new(*name, std::fs::read_to_string(path).unwrap())).unwrap();
            (scene.rig.sensing.forces, scene.physics.friction, scene.stop.time) = (*forces, *friction, *time);
            let [pruned, whole] = sensed(&scene, &policy);
            let first = pruned.iter().zip(&whole).position(|(a, b)| a != b);
            assert!(first.is_none() && pruned.len() == whole.len(), "{name}: number {first:?} of {}", whole.len());
        },
        |()| (),
    );
}
