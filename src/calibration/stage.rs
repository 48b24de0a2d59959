//! A stage in the simulated world: a whisker against a rod, step by step over a grid.

use crate::geometry::{Point2, Pose, ShapeError, Vector2, circle, rotate, wrap};
use crate::mujoco::{MujocoError, MujocoWorld};
use crate::physics::Physics;
use crate::solid::{Solid, SolidError};
use crate::world::{Fault, World};
use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::rig::{Platform, Rig, Whisker};
use vibrissa_runtime::signal::Command;

/// Step of the grid, both ways (m).
const STEP: f64 = 3e-3;
/// How far a whisker reaches beyond the near side of the rod, in the rows of the grid, and where the rod's middle is beside the
/// undeflected shaft in its columns, in steps: 9 times 20 sets.
const ROWS: std::ops::RangeInclusive<i32> = 2..=10;
const COLUMNS: std::ops::RangeInclusive<i32> = -1..=18;
/// Radius of the rod (m).
const ROD: f64 = 0.03;
/// Where the rod is beside a straight whisker that passes it, and how far ahead while the stage goes back there (m).
const BESIDE: f64 = 0.036;
const AHEAD: f64 = 0.05;
/// The length of a whisker (m) that all these are for; for others they are scaled.
const LENGTH: f64 = 0.1;
/// Size of the block that carries the whisker (m).
const BLOCK: f64 = 2e-3;
/// How many times as heavy as a platform, and its servos as strong, the stage is: no whisker pushes it aside.
const STIFF: f64 = 100.0;
/// How deep a tip may sink in (m) for a moment: where it slips off the rod it springs.
const SPRINGING: f64 = 3e-3;
/// Greatest speed of the stage (m/s), and the time (s) in which the rest of a way shrinks by a factor e.
const SPEED: f64 = 0.03;
const APPROACH: f64 = 0.1;
/// How near to a place the stage has to be (m), how long it then rests, how long readings are taken, and the longest that a step may
/// take (s).
const NEAR: f64 = 1e-6;
const REST: f64 = 0.3;
const READING: f64 = 0.1;
const PATIENCE: f64 = 30.0;
/// How far from the tip what is touched may be (m) to be touched by the tip.
const TIP: f64 = 2e-4;

/// Why the stage gave no sets.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// The whisker is too small for a rod.
    #[error("the whisker is too short for a rod to be made for it: {0}")]
    Rod(#[from] ShapeError),
    /// The same.
    #[error("the whisker is too short for a rod to be made for it: {0}")]
    Solid(#[from] SolidError),
    /// The world could not be built.
    #[error(transparent)]
    World(#[from] MujocoError),
    /// The world stopped being one.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// The stage did not get where it was to go.
    #[error("the stage did not come to rest; make `physics.step` smaller")]
    Restless,
}

/// Moves the base of a rig's whisker (by its index) over a grid of 3 mm steps before a rod, and takes a set wherever the two touch: in rows
/// that are ever nearer to the rod the tip is drawn round it, bent as a surface beside the platform bends it. `seed` fixes the noise of
/// the rig's sensors; a set is the mean of a tenth of a second.
///
/// # Errors
/// [`StageError`] when the world cannot be built or trusted.
///
/// # Panics
/// If the rig has no whisker with that index.
pub fn simulated_sets(rig: &Rig, physics: &Physics, whisker: usize, seed: u64) -> Result<Vec<ContactSet>, StageError> {
    let (bend, length) = (rig.whiskers[whisker].usual_bend_sign(), rig.whiskers[whisker].shaft.length);
    let scale = length / LENGTH;
    let mut stage = Stage::new(rig, physics, whisker, scale, seed)?;
    let mut sets = Vec::new();
    for row in ROWS {
        let near = length + (ROD - STEP * f64::from(row)) * scale;
        let place = |ahead: f64, beside: f64| Vector2::new(near + ahead * scale, bend * beside * scale);
        stage.go(place(AHEAD, -BESIDE))?;
        stage.go(place(0.0, -BESIDE))?;
        for column in COLUMNS {
            stage.go(place(0.0, STEP * f64::from(column)))?;
            sets.extend(stage.read()?);
        }
        stage.go(place(AHEAD, STEP * f64::from(*COLUMNS.end())))?;
    }
    Ok(sets)
}

/// A whisker on a small block, and a rod at the world's origin.
struct Stage {
    world: MujocoWorld,
    rod_radius: f64,
    length: f64,
    /// Control ticks a second (Hz).
    rate: f64,
    body: Pose,
    /// Mean base angle of the newest tick (rad).
    base_angle: f64,
}

impl Stage {
    fn new(rig: &Rig, physics: &Physics, whisker: usize, scale: f64, seed: u64) -> Result<Self, StageError> {
        // The base is in the middle of the block, and the undeflected shaft points ahead.
        let whisker = Whisker { base_body: Point2::origin(), direction_body: 0.0, ..rig.whiskers[whisker].clone() };
        let length = whisker.shaft.length;
        let block = BLOCK * scale;
        let platform = Platform {
            tail_width: block,
            nose_width: block,
            length: block,
            centre_of_mass: 0.5 * block,
            mass: STIFF * rig.platform.mass,
            inertia: STIFF * rig.platform.inertia,
            ..rig.platform.clone()
        };
        let penetration_limit = physics.penetration_limit.max(SPRINGING);
        let physics = Physics { penetration_limit, ..physics.clone() };
        let rig = Rig { platform, whiskers: vec![whisker], sensing: rig.sensing.clone() };
        let rod_radius = ROD * scale;
        let rod = Solid::inside(circle(Point2::origin(), rod_radius)?)?;
        let body = Pose { position: Point2::new(-2.0 * length, 0.0), heading: 0.0 };
        let world = MujocoWorld::new(&rig, &physics, &[rod], body, seed)?;
        Ok(Self { world, rod_radius, length, rate: rig.sensing.control_rate, body, base_angle: 0.0 })
    }

    /// One tick on the way to where the rod is at `rod_base` (m, from the base); gives what was left of the way (m).
    fn tick(&mut self, rod_base: Vector2) -> Result<f64, StageError> {
        let way = -rod_base - self.body.position.coords;
        let speed = (way.norm() / APPROACH).min(SPEED);
        let velocity_world = way.try_normalize(0.0).map_or(Vector2::zeros(), |ahead| speed * ahead);
        let samples = self.world.advance(&Command { velocity_world, yaw_rate: -self.body.heading / APPROACH })?;
        let angles = samples.iter().map(|sample| sample.whiskers[0].base_angle);
        self.base_angle = angles.sum::<f64>() / samples.len() as f64;
        self.body = samples.last().map_or(self.body, |sample| sample.body);
        Ok(way.norm())
    }

    /// Goes where the rod is at `rod_base` (m, from the base), and rests there.
    fn go(&mut self, rod_base: Vector2) -> Result<(), StageError> {
        let mut rested = 0;
        for _ in 0..self.ticks(PATIENCE) {
            let left = self.tick(rod_base)?;
            rested = if left < NEAR { rested + 1 } else { 0 };
            if rested >= self.ticks(REST) {
                return Ok(());
            }
        }
        Err(StageError::Restless)
    }

    /// Takes a set, if the whisker and the rod touch.
    fn read(&mut self) -> Result<Option<ContactSet>, StageError> {
        let ticks = self.ticks(READING);
        let (rod_base, mut sum) = (-self.body.position.coords, 0.0);
        for _ in 0..ticks {
            self.tick(rod_base)?;
            sum += self.base_angle;
        }
        Ok(self.world.whisker_contact(0).map(|(place, contact_length)| {
            // On the rod's surface, into which the tip has sunk by a little.
            let normal = place.coords.normalize();
            let from_base = self.rod_radius * normal - self.body.position.coords;
            ContactSet {
                contact_base: rotate(from_base, -self.body.heading),
                base_angle: sum / f64::from(ticks),
                normal: Some(wrap(normal.y.atan2(normal.x) - self.body.heading)),
                on_shaft: contact_length < self.length - TIP,
            }
        }))
    }

    /// How many ticks a time (s) takes.
    fn ticks(&self, time: f64) -> u32 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let ticks = (time * self.rate).ceil() as u32;
        ticks
    }
}
