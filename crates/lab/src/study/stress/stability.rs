//! The largest stable step of a world.

use crate::trial::{ExecuteError, build_world};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;
use vibrissa_world::geometry::Vector2;
use vibrissa_world::physics::{Integrator, Physics};
use vibrissa_world::scene::{Scene, WorldKind};
use vibrissa_world::world::{Fault, World};

use super::case::{CaseError, disk_beside, scene, set_links, set_step, stiffen};

/// A setting whose largest stable step is searched.
#[derive(Debug, Clone)]
pub struct StabilityCase {
    /// The setting.
    pub name: String,
    /// The world.
    pub world: WorldKind,
    rig: Rig,
    physics: Physics,
}

/// Tick rate of the tried steps (Hz), and the most steps in a tick. The shortest step is 0.1 ms.
const TICKS: f64 = 30.0;
const MAX_STEPS: u32 = 333;
/// Ticks of the shaking, of the rest after it, and of the path past a disk.
const SHAKEN: usize = 30;
const REST: usize = 60;
const PAST: usize = 75;

impl StabilityCase {
    /// All settings.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut cases = Vec::new();
        let mut add = |name: String, world, change: &dyn Fn(&mut Rig, &mut Physics)| {
            let mut rig = Rig::default();
            // The shafts must bend while they are shaken in the air.
            let mut physics = Physics { rigid_in_air: false, ..Physics::default() };
            change(&mut rig, &mut physics);
            cases.push(Self { name, world, rig, physics });
        };
        for integrator in Integrator::ALL {
            let others: &[usize] = if integrator == Integrator::default() { &[8, 40] } else { &[] };
            for &links in [16].iter().chain(others) {
                add(format!("{}, {links} links", integrator.name()), WorldKind::Mujoco, &|rig, physics| {
                    physics.integrator = integrator;
                    set_links(rig, links);
                });
            }
        }
        for world in WorldKind::ALL {
            for factor in [0.01, 0.1, 1.0, 10.0, 100.0] {
                add(format!("{factor} times as stiff"), world, &|rig, _| stiffen(rig, factor));
            }
        }
        cases
    }

    /// The largest stable step (s), by bisection over the number of steps in a tick. `None` if the shortest step is not
    /// stable.
    ///
    /// A step is stable if no fault occurs and the vibration of the whiskers decays after the platform was shaken. Then
    /// the platform is driven past a disk, also without a fault.
    ///
    /// # Errors
    /// [`CaseError`] if the disk cannot be made.
    pub fn largest_stable_step(&self) -> Result<Option<f64>, CaseError> {
        let scene = scene(&self.name, disk_beside()?, 0.0)?;
        let is_stable = |steps: u32| self.is_stable(&scene, step(steps));
        // Long steps are tried first because they take the least time. `low` steps in a tick are not stable, `high`
        // steps are.
        let (mut low, mut high) = (0, 1);
        while !is_stable(high) {
            if high == MAX_STEPS {
                return Ok(None);
            }
            (low, high) = (high, (2 * high).min(MAX_STEPS));
        }
        while high - low > 1 {
            let middle = u32::midpoint(low, high);
            if is_stable(middle) { high = middle } else { low = middle }
        }
        Ok(Some(step(high)))
    }

    fn is_stable(&self, scene: &Scene, step: f64) -> bool {
        let mut scene = scene.clone();
        (scene.rig, scene.physics) = (self.rig.clone(), self.physics.clone());
        // One sample for each step, so that any number of steps fits into a tick.
        scene.rig.sensing.sample_rate = step.recip();
        set_step(&mut scene, step);
        let shaken = self.world_of(&scene, false).is_ok_and(|mut world| calms_down(world.as_mut()).unwrap_or(false));
        shaken && self.world_of(&scene, true).is_ok_and(|mut world| passes(world.as_mut()).is_ok())
    }

    fn world_of(&self, scene: &Scene, with_disk: bool) -> Result<Box<dyn World>, ExecuteError> {
        let mut scene = scene.clone();
        if !with_disk {
            scene.solids.clear();
        }
        build_world(&scene, self.world.into(), 0)
    }
}

fn step(steps: u32) -> f64 {
    (TICKS * f64::from(steps)).recip()
}

/// Shakes the platform in free air. Returns true if the vibration of the whiskers has not grown some time later.
/// Compliant whiskers may vibrate for long.
fn calms_down(world: &mut dyn World) -> Result<bool, Fault> {
    let bend = |world: &mut dyn World, command: &Command| -> Result<f64, Fault> {
        let samples = world.advance(command)?;
        let angles = samples.iter().flat_map(|sample| sample.whiskers.iter().map(|reading| reading.base_angle.abs()));
        Ok(angles.fold(0.0, |most, angle| if angle <= most { most } else { angle }))
    };
    let mut most: f64 = 0.0;
    for tick in 0..SHAKEN {
        let sign = if tick / 3 % 2 == 0 { 1.0 } else { -1.0 };
        let command = Command { velocity_world: Vector2::new(0.0, 0.3 * sign), yaw_rate: 3.0 * sign };
        most = most.max(bend(world, &command)?);
    }
    for _ in 0..REST {
        bend(world, &Command::STOP)?;
    }
    Ok(bend(world, &Command::STOP)? <= most)
}

/// Drives past a disk.
fn passes(world: &mut dyn World) -> Result<(), Fault> {
    let command = Command { velocity_world: Vector2::new(0.0, 0.1), yaw_rate: 0.0 };
    (0..PAST).try_for_each(|_| world.advance(&command).map(|_| ()))
}
