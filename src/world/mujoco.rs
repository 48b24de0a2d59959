//! The MuJoCo world.

use std::sync::{Arc, Once};

use mujoco_rs::logging::set_log_handler;
use mujoco_rs::prelude::{MjData, MjModel};
use mujoco_rs::wrappers::mj_logging::{MjLogMessage, MjtLogLevel};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};

use crate::geometry::{Contour, Point2, Pose};
use crate::rig::Rig;
use crate::scene::{SolidError, mjcf};
use crate::signal::{Command, Sample};

use super::{Fault, World};

/// What each of MuJoCo's warning counters means, in their order.
const WARNINGS: [&str; 7] = [
    "an inertia matrix became singular",
    "more contacts than there is memory for",
    "more constraints than there is memory for",
    "a position is not a number or too large",
    "a velocity is not a number or too large",
    "an acceleration is not a number or too large",
    "a command is not a number or too large",
];

/// Why a MuJoCo world could not be built.
#[derive(Debug, thiserror::Error)]
pub enum MujocoError {
    /// The object has no solid.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// MuJoCo refused the generated model.
    #[error("MuJoCo refused the generated model: {0}; `vibrissa mjcf` prints the model")]
    Model(String),
}

/// A rig before an object, simulated by MuJoCo.
///
/// The same rig, object, start, seed and commands give the same samples, bit for bit.
pub struct MujocoWorld {
    data: MjData<Arc<MjModel>>,
    rig: Rig,
    steps_per_sample: usize,
    samples_per_tick: usize,
    samples: Vec<Sample>,
    steps_done: u64,
    noise: Option<Normal<f64>>,
    random: ChaCha8Rng,
    platform_geom: i32,
    body_touched: bool,
}

impl MujocoWorld {
    /// Builds the world with the platform at rest at `start` before `object`; `seed` fixes the sensors' noise.
    ///
    /// # Errors
    /// [`MujocoError`] when the object has no solid or MuJoCo refuses the model.
    pub fn new(rig: &Rig, object: Option<&Contour>, start: Pose, seed: u64) -> Result<Self, MujocoError> {
        route_engine_messages();
        let xml = mjcf(rig, object, start)?;
        let model = MjModel::from_xml_string(&xml).map_err(|error| MujocoError::Model(error.to_string()))?;
        let geom = model.name_to_id(mujoco_rs::wrappers::mj_model::MjtObjBase::mjOBJ_GEOM, "platform/body");
        let mut data = MjData::try_new(Arc::new(model)).map_err(|error| MujocoError::Model(error.to_string()))?;
        data.reset_keyframe(0).map_err(|error| MujocoError::Model(error.to_string()))?;
        let sensing = &rig.sensing;
        let samples_per_tick = whole(sensing.sample_rate / sensing.control_rate);
        Ok(Self {
            data,
            rig: rig.clone(),
            steps_per_sample: whole(1.0 / (sensing.sample_rate * rig.physics.step)),
            samples_per_tick,
            samples: Vec::with_capacity(samples_per_tick),
            steps_done: 0,
            noise: Normal::new(0.0, sensing.angle_noise).ok().filter(|_| sensing.angle_noise > 0.0),
            random: ChaCha8Rng::seed_from_u64(seed),
            platform_geom: geom.and_then(|id| i32::try_from(id).ok()).unwrap_or(-1),
            body_touched: false,
        })
    }

    fn time(&self) -> f64 {
        self.steps_done as f64 * self.rig.physics.step
    }

    fn step(&mut self) -> Result<(), Fault> {
        self.data.step();
        self.steps_done += 1;
        for contact in self.data.contact() {
            let depth = -contact.dist;
            let is_body = contact.geom.contains(&self.platform_geom);
            self.body_touched |= is_body && depth >= 0.0;
            if depth > self.rig.physics.penetration_limit {
                let body = if is_body { "the platform" } else { "a whisker" }.to_owned();
                let limit = self.rig.physics.penetration_limit;
                return Err(Fault::Penetration { time: self.time(), body, depth, limit });
            }
        }
        Ok(())
    }

    /// MuJoCo resets its state when it diverges and goes on as if nothing had been; only its counters tell.
    fn check(&self) -> Result<(), Fault> {
        let warned = self.data.warning().iter().zip(WARNINGS).find(|(warning, _)| warning.number > 0);
        let cause = match warned {
            Some((_, cause)) => cause,
            None if self.data.qpos().iter().any(|position| !position.is_finite()) => "a position is not a number",
            None => return Ok(()),
        };
        Err(Fault::Diverged { time: self.time(), cause: cause.to_owned() })
    }

    fn sample(&mut self) -> Sample {
        let positions = self.data.qpos();
        let mut sample = Sample {
            time: self.time(),
            body: Pose { position: Point2::new(positions[0], positions[1]), heading: positions[2] },
            whiskers: Default::default(),
        };
        let mut joint = 3;
        for ((index, whisker), reading) in self.rig.whiskers.iter().enumerate().zip(&mut sample.whiskers) {
            let noise = self.noise.map_or(0.0, |noise| noise.sample(&mut self.random));
            reading.base_angle = quantised(positions[joint] + noise, self.rig.sensing.angle_resolution);
            joint += 1 + whisker.shaft.links;
            if self.rig.sensing.forces {
                let force = &self.data.sensordata()[3 * index..3 * index + 3];
                // MuJoCo reports what the platform does to the shaft.
                (reading.axial, reading.shear) = (Some(-force[0]), Some(-force[1]));
            }
        }
        sample
    }
}

impl World for MujocoWorld {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        let velocity = command.velocity_world;
        self.data.ctrl_mut().copy_from_slice(&[velocity.x, velocity.y, command.yaw_rate]);
        self.body_touched = false;
        self.samples.clear();
        for _ in 0..self.samples_per_tick {
            for _ in 0..self.steps_per_sample {
                self.step()?;
            }
            let sample = self.sample();
            self.samples.push(sample);
        }
        self.check()?;
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.body_touched
    }
}

/// Rounds to a count; scenes are validated so that the value is one.
fn whole(value: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated small count")]
    let count = value.round().max(1.0) as usize;
    count
}

fn quantised(value: f64, resolution: f64) -> f64 {
    if resolution > 0.0 { (value / resolution).round() * resolution } else { value }
}

/// The version of the linked MuJoCo.
#[must_use]
pub fn engine_version() -> &'static str {
    mujoco_rs::mujoco_version()
}

/// Keeps MuJoCo from writing a log file into the working directory.
fn route_engine_messages() {
    static ROUTED: Once = Once::new();
    #[expect(
        unsafe_code,
        reason = "MuJoCo's log handler is global; nothing else in the process uses MuJoCo before this"
    )]
    // SAFETY: every use of MuJoCo in this crate comes after a call of this function, and `Once` lets one thread through.
    ROUTED.call_once(|| unsafe { set_log_handler(on_engine_message) });
}

/// Warnings are counted by the engine and become [`Fault`]s; an error ends the process, so its text must get out here.
#[expect(clippy::print_stderr, reason = "MuJoCo ends the process right after an error")]
fn on_engine_message(message: &MjLogMessage) {
    if matches!(message.level(), MjtLogLevel::mjLOG_ERROR) {
        eprintln!("error: MuJoCo stopped: {}", message.subject());
        std::process::exit(3);
    }
}
