//! Both worlds against each other: the same policy on the same scenes.

use vibrissa::built_in::SCENARIOS;
use vibrissa::figures::Metric;
use vibrissa::scene::WorldKind;

use crate::metrics::RUNS;

/// How far mean errors may be apart (mm).
const APART: f64 = 0.05;

#[test]
fn the_thesis_policy_does_as_well_in_both_worlds_on_all_scenes() {
    let of = |world: WorldKind| {
        RUNS.iter().map(|(_, result)| result).filter(move |run| run.policy == "thesis" && run.world == world.name())
    };
    let mut count = 0;
    for (mujoco, quasi_static) in of(WorldKind::Mujoco).zip(of(WorldKind::QuasiStatic)) {
        let name = &mujoco.scenario;
        assert_eq!((name, mujoco.outcome), (&quasi_static.scenario, quasi_static.outcome));
        let [mujoco, quasi_static] = [mujoco, quasi_static].map(|run| run.figure(Metric::ErrorMean).unwrap());
        assert!((mujoco - quasi_static).abs() < APART, "{name}: {mujoco:.4} and {quasi_static:.4} mm");
        count += 1;
    }
    assert_eq!(count, SCENARIOS.len());
}
