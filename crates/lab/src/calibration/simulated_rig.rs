//! A simulated calibration rig: it moves a whisker over a grid of positions in front of a rod.

use vibrissa_mujoco::{MujocoError, MujocoWorld};
use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::math;
use vibrissa_runtime::rig::{Platform, Rig, Whisker};
use vibrissa_runtime::signal::Command;
use vibrissa_world::geometry::{Point2, Pose, ShapeError, Vector2, circle, rotate, wrap};
use vibrissa_world::physics::Physics;
use vibrissa_world::solid::{Solid, SolidError};
use vibrissa_world::world::{Fault, World};

/// Step of the grid in both directions (m).
const STEP: f64 = 3e-3;
/// Rows and columns of the grid in steps, 9 times 20 sets. A row is the overlap of the whisker with the near side of
/// the rod. A column is the lateral distance of the rod's centre from the undeflected shaft.
const ROWS: std::ops::RangeInclusive<i32> = 2..=10;
const COLUMNS: std::ops::RangeInclusive<i32> = -1..=18;
/// Radius of the rod (m).
const ROD: f64 = 0.03;
/// Lateral distance of the rod from a straight whisker that passes it, and its distance ahead during the return to that
/// side (m).
const LATERAL_DISTANCE: f64 = 0.036;
const AHEAD: f64 = 0.05;
/// The length of a whisker (m) for which these values are valid. They are scaled for other whiskers.
const LENGTH: f64 = 0.1;
/// Size of the block that carries the whisker (m).
const BLOCK: f64 = 2e-3;
/// Factor of a platform's mass and servo stiffness, so that no whisker deflects the rig.
const MASS_FACTOR: f64 = 100.0;
/// Largest short penetration depth of the tip (m), during a snap-off from the rod.
const PENETRATION_LIMIT: f64 = 3e-3;
/// Highest speed of the rig (m/s), and the time constant (s) of the approach to a position.
const SPEED: f64 = 0.03;
const APPROACH: f64 = 0.1;
/// Largest distance from a position (m), time of rest there, time of the readings, and the time limit of a step (s).
const NEAR: f64 = 1e-6;
const REST: f64 = 0.3;
const READING: f64 = 0.1;
const PATIENCE: f64 = 30.0;
/// Largest distance between the tip and a tip contact (m).
const TIP: f64 = 2e-4;

/// The error of a simulated calibration.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationRigError {
    /// The whisker is too small for a rod.
    #[error("the whisker is too short for a rod to be made for it: {0}")]
    Rod(#[from] ShapeError),
    /// The rod cannot be simulated.
    #[error("the whisker is too short for a rod to be made for it: {0}")]
    Solid(#[from] SolidError),
    /// The world could not be built.
    #[error(transparent)]
    World(#[from] MujocoError),
    /// The simulation cannot be trusted.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// The rig did not reach a position.
    #[error("the calibration rig did not come to rest; make `physics.step` smaller")]
    NotAtRest,
}

/// Moves the base of a rig's whisker (by its index) over a grid of 3 mm steps in front of a rod. Each position in
/// contact gives a set. In each row the tip is dragged around the rod, and the rows approach the rod. The whisker bends
/// as on a surface that a policy follows. A set is the mean of a tenth of a second. `seed` is the seed of the sensor
/// noise.
///
/// # Errors
/// [`CalibrationRigError`] if the world cannot be built or trusted.
///
/// # Panics
/// If the rig has no whisker with that index.
pub fn simulated_sets(
    rig: &Rig,
    physics: &Physics,
    whisker: usize,
    seed: u64,
) -> Result<Vec<ContactSet>, CalibrationRigError> {
    let (bend, length) = (rig.whiskers[whisker].side(), rig.whiskers[whisker].shaft.length);
    let scale = length / LENGTH;
    let mut calibration_rig = CalibrationRig::new(rig, physics, whisker, scale, seed)?;
    let mut sets = Vec::new();
    for row in ROWS {
        let near = length + (ROD - STEP * f64::from(row)) * scale;
        let position = |ahead: f64, beside: f64| Vector2::new(near + ahead * scale, bend * beside * scale);
        calibration_rig.go(position(AHEAD, -LATERAL_DISTANCE))?;
        calibration_rig.go(position(0.0, -LATERAL_DISTANCE))?;
        for column in COLUMNS {
            calibration_rig.go(position(0.0, STEP * f64::from(column)))?;
            sets.extend(calibration_rig.read()?);
        }
        calibration_rig.go(position(AHEAD, STEP * f64::from(*COLUMNS.end())))?;
    }
    Ok(sets)
}

/// A whisker on a small block, and a rod at the world's origin.
struct CalibrationRig {
    world: MujocoWorld,
    rod_radius: f64,
    length: f64,
    /// Control rate (Hz).
    rate: f64,
    body: Pose,
    /// Mean base angle of the newest tick (rad).
    base_angle: f64,
}

impl CalibrationRig {
    fn new(rig: &Rig, physics: &Physics, whisker: usize, scale: f64, seed: u64) -> Result<Self, CalibrationRigError> {
        // The base is at the centre of the block, and the undeflected shaft points ahead.
        let whisker = Whisker { base_body: Point2::origin(), direction_body: 0.0, ..rig.whiskers[whisker].clone() };
        let length = whisker.shaft.length;
        let block = BLOCK * scale;
        let platform = Platform {
            tail_width: block,
            nose_width: block,
            length: block,
            centre_of_mass: 0.5 * block,
            mass: MASS_FACTOR * rig.platform.mass,
            inertia: MASS_FACTOR * rig.platform.inertia,
            ..rig.platform.clone()
        };
        let penetration_limit = physics.penetration_limit.max(PENETRATION_LIMIT);
        let physics = Physics { penetration_limit, ..physics.clone() };
        let rig = Rig { platform, whiskers: vec![whisker], sensing: rig.sensing.clone() };
        let rod_radius = ROD * scale;
        let rod = Solid::inside(circle(Point2::origin(), rod_radius)?)?;
        let body = Pose { position: Point2::new(-2.0 * length, 0.0), heading: 0.0 };
        let world = MujocoWorld::new(&rig, &physics, &[rod], body, seed)?;
        Ok(Self { world, rod_radius, length, rate: rig.sensing.control_rate, body, base_angle: 0.0 })
    }

    /// One tick of motion towards the position at which the rod is at `rod_base` (m, from the base). Returns the
    /// remaining distance (m).
    fn tick(&mut self, rod_base: Vector2) -> Result<f64, CalibrationRigError> {
        let way = -rod_base - self.body.position.coords;
        let speed = (way.norm() / APPROACH).min(SPEED);
        let velocity_world = way.try_normalize(0.0).map_or(Vector2::zeros(), |ahead| speed * ahead);
        let samples = self.world.advance(&Command { velocity_world, yaw_rate: -self.body.heading / APPROACH })?;
        let angles = samples.iter().map(|sample| sample.whiskers[0].base_angle);
        self.base_angle = angles.sum::<f64>() / samples.len() as f64;
        self.body = samples.last().map_or(self.body, |sample| sample.body);
        Ok(way.norm())
    }

    /// Moves to the position at which the rod is at `rod_base` (m, from the base), and rests there.
    fn go(&mut self, rod_base: Vector2) -> Result<(), CalibrationRigError> {
        let mut rested = 0;
        for _ in 0..self.ticks(PATIENCE) {
            let left = self.tick(rod_base)?;
            rested = if left < NEAR { rested + 1 } else { 0 };
            if rested >= self.ticks(REST) {
                return Ok(());
            }
        }
        Err(CalibrationRigError::NotAtRest)
    }

    /// Measures a set. `None` without contact.
    fn read(&mut self) -> Result<Option<ContactSet>, CalibrationRigError> {
        let ticks = self.ticks(READING);
        let (rod_base, mut sum) = (-self.body.position.coords, 0.0);
        for _ in 0..ticks {
            self.tick(rod_base)?;
            sum += self.base_angle;
        }
        Ok(self.world.whisker_contact(0).map(|(position, contact_length)| {
            // On the surface of the rod, which the tip penetrates slightly.
            let normal = position.coords.normalize();
            let from_base = self.rod_radius * normal - self.body.position.coords;
            ContactSet {
                contact_base: rotate(from_base, -self.body.heading),
                base_angle: sum / f64::from(ticks),
                normal: Some(wrap(math::atan2(normal.y, normal.x) - self.body.heading)),
                on_shaft: contact_length < self.length - TIP,
            }
        }))
    }

    /// Number of ticks in a time (s).
    fn ticks(&self, time: f64) -> u32 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let ticks = (time * self.rate).ceil() as u32;
        ticks
    }
}
