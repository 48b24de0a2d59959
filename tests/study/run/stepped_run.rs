//! Runs that their caller steps.

use vibrissa::built_in::SCENARIOS;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, unit};
use vibrissa::request::{Input, PolicyInput, TrialRequest};
use vibrissa::run::Step;
use vibrissa::scene::WorldKind;
use vibrissa::trial::Trial;
use vibrissa_runtime::machine::{BodyScalar, Senses};
use vibrissa_runtime::signal::Command;

/// A policy that stands still on the disk, in the quasi-static world.
fn trial() -> Trial {
    let still = "machine still\n\nwhisker r0\n\ninitial Still\n\nstate Still { record r0 stop }\n";
    let request = TrialRequest {
        policy: Some(PolicyInput::Text(Source::new("still.fsm", still))),
        world: Some(WorldKind::QuasiStatic),
        ..TrialRequest::new(Input::BuiltIn(&SCENARIOS[0]))
    };
    request.prepare().unwrap().trial
}

#[test]
fn the_callers_commands_steer_the_platform_instead_of_the_policy() {
    let trial = trial();
    let (mut world, mut run) = (trial.world().unwrap(), trial.begin().unwrap());
    let start = trial.scene.start;
    let back = Command { velocity_world: -0.1 * unit(start.heading), yaw_rate: 0.0 };
    for _ in 0..30 {
        assert_eq!(run.step(world.as_mut(), &mut ()), Step::Running);
        assert_eq!(run.command(), run.trace().ticks.last().unwrap().command);
        run.replace_command(back);
    }
    let newest = run.trace().ticks.last().unwrap();
    assert_eq!((run.command(), newest.command), (back, back));
    // A period passes before the first command of the caller, and the servos lag behind.
    let expected = Point2::from(start.position.coords - 0.1 * (29.0 / 30.0 - 0.05) * unit(start.heading));
    assert!((newest.body.position - expected).norm() < 2e-3, "{:?}", newest.body);
    // Perception knows these commands, so it does not take the motion for a disturbance.
    let shortfall = run.control().perception().body(BodyScalar::Shortfall);
    assert!(shortfall < 5e-3, "{shortfall} m/s");
}
