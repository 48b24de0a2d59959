//! Worlds against each other, on ways where the difference is known.

use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::machine::Program;
use vibrissa::policy::{compile, gather};
use vibrissa::scene::Scene;
use vibrissa::study::Ending;
use vibrissa::study::bench::{POLICIES, SCENARIOS};
use vibrissa::study::tiers::{Tier, TierRow, compare_tiers, tiers_table};

fn thesis() -> Arc<Program> {
    let source = Source::new(POLICIES[0].path, POLICIES[0].text);
    Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap())
}

/// A scene of the bench that ends after so long (s), whatever it has got to.
fn scene(name: &str, time: f64) -> Scene {
    let path = format!("scenarios/{name}.yaml");
    let file = SCENARIOS.iter().find(|file| file.path == path).unwrap();
    let mut scene = Scene::from_yaml(&Source::new(file.path, file.text)).unwrap();
    (scene.stop.time, scene.stop.loop_closed, scene.stop.reached) = (time, None, None);
    scene
}

/// The row of a tier against the quasi-static world, in so long (s) of a scene.
fn against_quasi_static(name: &str, time: f64, tier: impl FnOnce(&Scene) -> Tier) -> TierRow {
    let scene = scene(name, time);
    let rows = compare_tiers(&scene, &thesis(), &Tier::quasi_static(&scene), &[tier(&scene)]).unwrap();
    let [row] = <[TierRow; 1]>::try_from(rows).unwrap();
    assert_eq!((row.outcome, &row.stopped), (Ending::Completed, &None), "{row:?}");
    assert!((row.along_s - time).abs() < 1e-9 && row.compared > 200, "{row:?}");
    row
}

#[test]
fn a_world_is_not_apart_from_itself() {
    for name in ["box", "zigzag-tunnel"] {
        let row = against_quasi_static(name, 40.0, Tier::quasi_static);
        let differences = [row.tip_mm.unwrap().max, row.moment_un_m.unwrap().max, row.moment_share.unwrap()];
        assert_eq!(differences.map(f64::to_bits), [0; 3], "{row:?}");
        assert!(row.contour_mm.unwrap() < 1e-9, "{row:?}");
    }
}

#[test]
fn a_shaft_that_is_stiffer_by_a_hundredth_has_a_hundredth_more_moment() {
    let row = against_quasi_static("disk", 40.0, |scene| {
        let mut tier = Tier::quasi_static(scene);
        for whisker in &mut tier.rig.whiskers {
            whisker.shaft.young_modulus *= 1.01;
        }
        tier
    });
    // The hinge is not stiffer.
    assert!((row.moment_share.unwrap() - 0.01).abs() < 2e-4, "{row:?}");
    let table = tiers_table(std::slice::from_ref(&row));
    assert!(
        ["disk", "thesis", "quasistatic", "1.00 %", "completed"].iter().all(|cell| table.contains(cell)),
        "{table}"
    );
    // Tips lie on the same surface: they slide along it by no more than the hinge turns.
    assert!(row.tip_mm.unwrap().max < 5e-3, "{row:?}");
    // Perception takes that for a bend by a hundredth more: by 3 µrad, at some 0.1 mm/µrad.
    assert!((0.2..0.5).contains(&row.contour_mm.unwrap()), "{row:?}");
}

#[cfg(feature = "sim")]
#[test]
fn the_chain_by_mujoco_is_apart_by_what_it_sinks_in() {
    let row = against_quasi_static("disk", 25.0, Tier::chain);
    assert!((0.01..0.2).contains(&row.tip_mm.unwrap().mean), "{row:?}");
    assert!(row.moment_share.unwrap() < 0.01, "{row:?}");
    let hard = against_quasi_static("disk", 25.0, |scene| {
        let mut tier = Tier::chain(scene);
        let step = 1.0 / 1800.0;
        let physics = &mut tier.rig.physics;
        (physics.step, physics.calm_step, physics.contact_time) = (step, step, step);
        tier
    });
    assert!(5.0 * hard.tip_mm.unwrap().mean < row.tip_mm.unwrap().mean, "{hard:?}");
    assert!(5.0 * hard.moment_share.unwrap() < row.moment_share.unwrap(), "{hard:?}");
}
