//! Run time against error over the settings of a world.

use std::sync::Arc;

use vibrissa::built_in::{DEFAULT_POLICY, SCENARIOS};
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Vector2, unit};
use vibrissa::mismatch::{Mismatch, Property};
use vibrissa::policy::{compile, gather};
use vibrissa::report::{pareto_picture, pareto_table};
use vibrissa::results::Ending;
use vibrissa::scenario;
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::study::pareto::{Change, Pareto, Setting, measure};
use vibrissa_runtime::machine::{ContactEstimatorKind, Program};

fn disk() -> Scene {
    scenario::read(&Source::new(SCENARIOS[0].path, SCENARIOS[0].text)).unwrap()
}

/// The default policy for planar whiskers, which cannot leave their plane. Swept back, they would show the length of a link more.
fn program() -> Arc<Program> {
    let text = DEFAULT_POLICY.text.replace("ribbon    = false", "ribbon    = true");
    assert_ne!(text, DEFAULT_POLICY.text);
    let source = Source::new(DEFAULT_POLICY.path, text);
    Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap())
}

/// The disk with an array whose whiskers are stiffer than perception knows.
fn stiff() -> Scene {
    let mut mismatch = Mismatch::default();
    mismatch.common.set(Property::Stiffness, 0.05);
    Scene { mismatch: Some(mismatch), ..disk() }
}

/// What comes of the default and some other changes.
fn measured(world: WorldKind, changes: &[&[Change]]) -> Pareto {
    let others = changes.iter().map(|changes| Setting(changes.to_vec()));
    let settings: Vec<_> = [Setting::unchanged()].into_iter().chain(others).collect();
    measure(&disk(), &stiff(), &program(), world, &settings, 1, |_| ()).unwrap()
}

/// What takes less time is farther off. Less work is fewer links or fewer steps: how long either takes need not be known for that.
#[cfg(feature = "sim")]
#[test]
fn the_default_is_on_the_front() {
    use vibrissa::physics::Solver;
    let no_dearer: [&[Change]; 6] = [
        &[Change::Links(8)],
        &[Change::Links(12)],
        &[Change::Step(1.0 / 150.0)],
        &[Change::Links(8), Change::Step(1.0 / 150.0)],
        &[Change::Links(12), Change::Solver(Solver::ConjugateGradients)],
        &[Change::Links(12), Change::Solver(Solver::Newton)],
    ];
    let pareto = measured(WorldKind::Mujoco, &no_dearer);
    let [default, others @ ..] = pareto.settings.as_slice() else { panic!("no default") };
    assert_eq!(default.outcome, Ending::Completed);
    assert!(default.error_mm.unwrap() < 0.04);
    for other in others {
        let is_farther = other.outcome != Ending::Completed || other.error_mm > default.error_mm;
        assert!(
            is_farther,
            "{} is off by {:?} mm, the default by {:?} mm",
            other.setting, other.error_mm, default.error_mm
        );
    }
    let physics = disk().physics;
    assert_eq!(physics.solver, Solver::ProjectedGaussSeidel, "the others take longer (docs/pareto.md)");
    assert!(physics.contact_time <= physics.step, "no contacts are harder");
}

#[test]
fn settings_are_measured_against_the_default_and_the_exact_contour_and_drawn() {
    let changes: [&[Change]; 3] = [
        &[Change::Links(8)],
        &[Change::ContactEstimator(ContactEstimatorKind::Sliding)],
        &[Change::Links(40), Change::Step(1.0 / 150.0)],
    ];
    let pareto = measured(WorldKind::QuasiStatic, &changes);
    let [default, _, same_model, fine] = pareto.settings.as_slice() else { panic!("four settings") };
    assert_eq!((default.relative_time, default.relative_time_range), (Some(1.0), Some([1.0, 1.0])));
    for row in &pareto.settings {
        assert_eq!(row.outcome, Ending::Completed, "{}", row.setting);
        assert!(row.error_mm.unwrap() < 0.02, "{}: {:?} mm", row.setting, row.error_mm);
    }
    assert!(pareto.settings.iter().all(|row| row.relative_time.is_some_and(|time| time > 0.0)));
    assert_eq!((fine.links, fine.step_ms.round()), (40, 7.0));
    // The same perception of the same samples, once in the loop and once after it.
    assert!((same_model.error_mm.unwrap() - default.error_mm.unwrap()).abs() < 1e-9);
    assert!(pareto.settings.iter().any(|row| row.on_front.exact));
    // Optimal by one of the errors and by no other setting's equal one is optimal by both together.
    assert!(pareto.settings.iter().any(|row| row.on_front.mismatched && row.on_front.together));
    // With a wrong stiffness, whichever simulator and estimator.
    for row in &pareto.settings {
        assert_eq!(row.mismatched_outcome, Ending::Completed, "{}", row.setting);
        assert!(row.mismatched_mm > row.error_mm.map(|error| error + 0.1), "{}", row.setting);
    }
    // There was no fine run.
    assert!(pareto.floor_mm.is_none() && pareto.settings.iter().all(|row| row.fine_mm.is_none() && !row.on_front.fine));
    let table = pareto_table(&pareto).wide();
    assert!(pareto.settings.iter().all(|row| table.contains(&row.setting)), "{table}");
    let picture = pareto_picture(&pareto);
    assert!(picture.starts_with("<svg") && picture.contains("4 · 40 links, 6.67 ms"), "{picture}");
}

#[test]
fn a_default_that_cannot_be_run_is_an_error_and_of_the_others_one_that_cannot_is_refused() {
    let mut scene = disk();
    scene.stop.time = 0.1;
    // The tip of a whisker is in the disk by a tenth of its limit, which MuJoCo bears.
    let outline = scene.solids[0].outline().clone();
    let whisker = &scene.rig.whiskers[0];
    let tip = scene.start.point_to_world(whisker.base_body + whisker.shaft.length * unit(whisker.direction_body));
    let distance = |aside: Vector2| outline.signed_distance(tip + aside);
    let rise = |aside: Vector2| (distance(1e-6 * aside) - distance(-1e-6 * aside)) / 2e-6;
    let outward = Vector2::new(rise(Vector2::x()), rise(Vector2::y())).normalize();
    scene.start.position -= (distance(Vector2::zeros()) + 0.1e-3) * outward;
    let settings = [Setting::unchanged(), Setting(vec![Change::World(WorldKind::QuasiStatic)])];
    let of = |world| measure(&scene, &stiff(), &program(), world, &settings, 1, |_| ());
    assert!(of(WorldKind::QuasiStatic).is_err());
    if cfg!(feature = "sim") {
        let pareto = of(WorldKind::Mujoco).unwrap();
        let refused = &pareto.settings[1];
        assert_eq!((refused.outcome, refused.relative_time), (Ending::Refused, None));
        assert!(refused.reason.as_deref().is_some_and(|reason| reason.contains("another start")));
    }
}
