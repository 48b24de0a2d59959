//! Worlds against each other, on ways where the difference is known.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use vibrissa::built_in::{POLICIES, SCENARIOS};
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Vector2, unit};
use vibrissa::policy::{compile, gather};
use vibrissa::report::worlds_table;
use vibrissa::results::Ending;
use vibrissa::scenario;
use vibrissa::scene::Scene;
use vibrissa::study::worlds::{Simulation, WorldsRow, compare_worlds};
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::mechanics::Elastica;
use vibrissa_runtime::rig::{Rig, Whisker};

fn thesis() -> Arc<Program> {
    let source = Source::new(POLICIES[0].path, POLICIES[0].text);
    Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap())
}

/// A scene of the bench that ends after so long (s), whatever it has got to.
fn scene(name: &str, time: f64) -> Scene {
    let path = format!("scenarios/{name}.yaml");
    let file = SCENARIOS.iter().find(|file| file.path == path).unwrap();
    let mut scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
    (scene.stop.time, scene.stop.loop_closed, scene.stop.reached) = (time, None, None);
    // They hold for the whole scene.
    scene.expect.clear();
    scene
}

/// The row of a tier against the quasi-static world, in so long (s) of a scene.
fn against_quasi_static(name: &str, time: f64, tier: impl FnOnce(&Scene) -> Simulation) -> WorldsRow {
    let scene = scene(name, time);
    let rows = compare_worlds(&scene, &thesis(), &Simulation::quasi_static(&scene), &[tier(&scene)]).unwrap();
    let [row] = <[WorldsRow; 1]>::try_from(rows).unwrap();
    assert_eq!((row.outcome, &row.stopped), (Ending::Completed, &None), "{row:?}");
    assert!((row.along_s - time).abs() < 1e-9 && row.compared > 200, "{row:?}");
    row
}

/// The base angle (rad) of a row's ticks in the mean, of the reference.
fn base_angle(row: &WorldsRow, rig: &Rig) -> f64 {
    1e-6 * row.moment_un_m.unwrap().mean / row.moment_share.unwrap() / rig.whiskers[0].hinge.stiffness
}

/// The way (base frame) in which a surface pushes a whisker whose platform heads along it.
fn normal(whisker: &Whisker) -> Vector2 {
    unit(-whisker.side() * FRAC_PI_2 - whisker.direction_body)
}

/// The tip (m, base frame) of a whisker that such a surface bends to a base angle (rad, by its size).
fn tip(whisker: &Whisker, base_angle: f64) -> Vector2 {
    let (elastica, normal) = (Elastica::new(whisker), normal(whisker));
    elastica.solve_tip(base_angle.copysign(normal.y), normal.y.atan2(normal.x), &elastica.straight()).unwrap().tip_base
}

#[test]
fn what_statics_do_not_feel_keeps_worlds_together_to_the_last_bit() {
    for name in ["box", "zigzag-tunnel"] {
        let row = against_quasi_static(name, 40.0, |scene| {
            let mut tier = Simulation::quasi_static(scene);
            for whisker in &mut tier.rig.whiskers {
                (whisker.shaft.density, whisker.shaft.damping) = (1e4, 0.1);
            }
            tier
        });
        let differences = [row.tip_mm.unwrap().max, row.moment_un_m.unwrap().max, row.moment_share.unwrap()];
        assert_eq!(differences.map(f64::to_bits), [0; 3], "{row:?}");
        assert!(row.contour_mm.unwrap() < 1e-9, "{row:?}");
    }
}

#[test]
fn a_shaft_that_is_stiffer_by_a_hundredth_has_a_hundredth_more_moment() {
    let row = against_quasi_static("disk", 40.0, |scene| {
        let mut tier = Simulation::quasi_static(scene);
        for whisker in &mut tier.rig.whiskers {
            whisker.shaft.young_modulus *= 1.01;
        }
        tier
    });
    // The hinge is not stiffer.
    assert!((row.moment_share.unwrap() - 0.01).abs() < 2e-4, "{row:?}");
    let table = worlds_table(std::slice::from_ref(&row)).wide();
    assert!(
        ["disk", "thesis", "quasistatic", "1.00 %", "completed"].iter().all(|cell| table.contains(cell)),
        "{table}"
    );
    // Tips lie on the same surface: they slide along it by no more than the hinge turns.
    assert!(row.tip_mm.unwrap().max < 5e-3, "{row:?}");
    // Perception takes the moment for that of the softer shaft. The policy keeps its heading along the surface.
    let rig = scene("disk", 40.0).rig;
    let mut stiffer = rig.whiskers[0].clone();
    stiffer.shaft.young_modulus *= 1.01;
    let angle = base_angle(&row, &rig);
    let [perceived, real] = [&rig.whiskers[0], &stiffer].map(|whisker| tip(whisker, angle));
    let apart = 1e3 * (perceived - real).dot(&normal(&stiffer)).abs();
    let contour = row.contour_mm.unwrap();
    assert!((contour / apart - 1.0).abs() < 0.02, "{contour} mm, {apart} mm");
}

/// How deep (mm) the tip of a rig's right whisker sinks into a disk at a base angle (rad), its platform heading along the surface.
#[cfg(feature = "sim")]
fn sunk_in(rig: &Rig, physics: &vibrissa::physics::Physics, base_angle: f64) -> f64 {
    use vibrissa::geometry::{Point2, Pose, circle};
    use vibrissa::mujoco::MujocoWorld;
    use vibrissa::solid::Solid;
    use vibrissa::world::World;
    use vibrissa_runtime::signal::Command;

    const RADIUS: f64 = 0.3;
    let start = Pose { position: Point2::origin(), heading: FRAC_PI_2 };
    let whisker = &rig.whiskers[0];
    let tip = start.point_to_world(whisker.base_body) + whisker.shaft.length * unit(FRAC_PI_2 + whisker.direction_body);
    let centre = tip + Vector2::new(RADIUS + 2e-3, 0.0);
    let disk = [Solid::inside(circle(centre, RADIUS).unwrap()).unwrap()];
    let mut world = MujocoWorld::pruned(rig, physics, &disk, start, 0).unwrap();
    let aside = Command { velocity_world: Vector2::new(0.01, 0.0), yaw_rate: 0.0 };
    let mut reading = 0.0;
    for _ in 0..300 {
        let command = if f64::abs(reading) < base_angle { &aside } else { &Command::STOP };
        reading = world.advance(command).unwrap().last().unwrap().whiskers[0].base_angle;
    }
    assert!((reading.abs() / base_angle - 1.0).abs() < 0.05, "{reading} instead of {base_angle}");
    // The place of a contact is half as deep as the contact.
    2e3 * (RADIUS - (world.whisker_contact(0).unwrap().0 - centre).norm())
}

#[cfg(feature = "sim")]
#[test]
fn the_chain_by_mujoco_is_apart_by_what_it_sinks_in() {
    let hard = |scene: &Scene| {
        let mut tier = Simulation::chain(scene);
        let step = 1.0 / 1800.0;
        let physics = &mut tier.physics;
        (physics.step, physics.calm_step, physics.contact_time) = (step, step, step);
        tier
    };
    let rows = [Simulation::chain, hard].map(|tier| {
        let row = against_quasi_static("disk", 25.0, tier);
        let Simulation { rig, physics, .. } = tier(&scene("disk", 25.0));
        let (whisker, angle) = (&rig.whiskers[0], base_angle(&row, &rig));
        let depth = sunk_in(&rig, &physics, angle);
        // The tip that is held back less by this depth goes where the whisker springs, which is aslant to the surface.
        let back = (tip(whisker, 1.001 * angle) - tip(whisker, angle)) / 1e-3;
        let share = 1e-3 * depth / back.dot(&normal(whisker)).abs();
        let tips = 1e3 * share * back.norm();
        // Ticks of the first touch and of turning are among them, with what motion makes.
        assert!((row.tip_mm.unwrap().mean / tips - 1.0).abs() < 0.15, "{tips} mm, {row:?}");
        assert!((row.moment_share.unwrap() - share).abs() < 1e-4, "{share}, {row:?}");
        row
    });
    let [soft, hard] = rows.map(|row| row.tip_mm.unwrap().mean);
    assert!(5.0 * hard < soft, "{hard} mm, {soft} mm");
}
