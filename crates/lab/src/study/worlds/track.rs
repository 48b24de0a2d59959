//! Whiskers that are moved along a path.

use crate::run::Trace;
use crate::trial::{ExecuteError, build_world};
use vibrissa_runtime::signal::Command;
use vibrissa_world::geometry::{Point2, Pose, wrap};
use vibrissa_world::scene::Scene;

use super::simulation::Simulation;

/// Factor of the platform's mass for the carrier of the whiskers, so that no whisker deflects it.
const MASS_FACTOR: f64 = 100.0;
/// Time constant of its servos (s), a sixth of a tick at 30 Hz. If the velocity changes by `Δv`, the position error at
/// the end of the tick is `Δv` times this. It is 0.25 mm for 50 mm/s, and the next command corrects it. It is equal in
/// every simulation.
const SERVO: f64 = 5e-3;

/// The whiskers of a simulation along a path.
pub(super) struct Track {
    /// The whiskers of each tick in the rig's order, as far as the simulation follows the path.
    pub(super) ticks: Vec<Vec<Instant>>,
    /// The fault that stopped it.
    pub(super) fault: Option<String>,
}

/// One whisker in one tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instant {
    /// Position of the tip at the end of the tick (m, world frame).
    pub(super) tip: Point2,
    /// Base moment (N m) at the end of the tick.
    pub(super) moment: f64,
    /// The least magnitude of the base angle (rad) in the tick.
    pub(super) least: f64,
    /// The difference (rad) between the greatest and the least base angle in the tick.
    pub(super) range: f64,
}

impl Track {
    /// Moves the whiskers of a simulation from the scene's start along the poses of a run.
    pub(super) fn along(path: &Trace, scene: &Scene, simulation: &Simulation) -> Result<Self, ExecuteError> {
        let mut scene = simulation.scene(scene);
        let rig = &mut scene.rig;
        rig.platform.mass *= MASS_FACTOR;
        rig.platform.inertia *= MASS_FACTOR;
        rig.platform.servo = SERVO;
        (rig.sensing.angle_noise, rig.sensing.angle_resolution) = (0.0, 0.0);
        let mut world = build_world(&scene, simulation.world.into(), scene.seed)?;
        let mut body = scene.start;
        let (mut ticks, mut fault) = (Vec::with_capacity(path.ticks.len()), None);
        for aim in path.ticks.iter().map(|tick| tick.body) {
            let samples = match world.advance(&towards(&body, &aim, path.period)) {
                Ok(samples) => samples.to_vec(),
                Err(cause) => {
                    fault = Some(cause.to_string());
                    break;
                }
            };
            body = samples.last().map_or(body, |sample| sample.body);
            let whiskers = scene.rig.whiskers.iter().enumerate().map(|(index, whisker)| {
                let angles = || samples.iter().map(|sample| sample.whiskers[index].base_angle);
                let range = |(low, high): (f64, f64), angle: f64| (low.min(angle), high.max(angle));
                let (low, high) = angles().fold((f64::INFINITY, f64::NEG_INFINITY), range);
                Instant {
                    tip: world.tip(index),
                    moment: whisker.hinge.stiffness * angles().next_back().unwrap_or_default(),
                    least: angles().map(f64::abs).fold(f64::INFINITY, f64::min),
                    range: high - low,
                }
            });
            ticks.push(whiskers.collect());
        }
        Ok(Self { ticks, fault })
    }
}

/// The command that moves the platform from one pose to another in a time (s).
fn towards(from: &Pose, to: &Pose, period: f64) -> Command {
    Command {
        velocity_world: (to.position - from.position) / period,
        yaw_rate: wrap(to.heading - from.heading) / period,
    }
}
