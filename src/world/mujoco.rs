//! The MuJoCo world.

use std::sync::{Arc, Once};

use crate::geometry::{Point2, Pose, unit};
use crate::rig::{Rig, Whisker};
use crate::scene::{Solid, mjcf};
use crate::signal::{Command, Sample};
use mujoco_rs::logging::set_log_handler;
use mujoco_rs::prelude::{MjData, MjModel};
use mujoco_rs::wrappers::mj_logging::{MjLogMessage, MjtLogLevel};
use mujoco_rs::wrappers::mj_model::MjtObjBase;

use super::sensors::{Sensors, whole};
use super::{Fault, World};

/// What each of MuJoCo's warning counters means and what to do about it, in their order.
const WARNINGS: [&str; 7] = [
    "an inertia matrix became singular; give the rig heavier parts",
    "there are more contacts than memory for them; make `links` smaller",
    "there are more constraints than memory for them; make `links` smaller",
    "a position is too large or not a number; make `physics.step` smaller",
    "a velocity is too large or not a number; make `physics.step` smaller",
    "an acceleration is too large or not a number; make `physics.step` smaller or the shaft less stiff",
    "a command is too large or not a number",
];

/// Why a MuJoCo world could not be built.
#[derive(Debug, thiserror::Error)]
pub enum MujocoError {
    /// MuJoCo refused the generated model.
    #[error("MuJoCo refused the generated model: {0}; `vibrissa mjcf` prints the model")]
    Model(String),
}

/// A rig before solids, simulated by MuJoCo.
///
/// The same rig, solids, start, seed and commands give the same samples, bit for bit.
pub struct MujocoWorld {
    data: MjData<Arc<MjModel>>,
    rig: Rig,
    steps_per_sample: usize,
    samples_per_tick: usize,
    samples: Vec<Sample>,
    steps_done: u64,
    sensors: Sensors,
    platform_geom: i32,
    /// The geom of every whisker's first link; those of the others come one after the other.
    first_links: Vec<i32>,
    body_touched: bool,
}

impl MujocoWorld {
    /// Builds the world with the platform at rest at `start` before `solids`; `seed` fixes the sensors' noise.
    ///
    /// # Errors
    /// [`MujocoError`] when MuJoCo refuses the model.
    pub fn new(rig: &Rig, solids: &[Solid], start: Pose, seed: u64) -> Result<Self, MujocoError> {
        route_engine_messages();
        let refused = |error: &dyn std::fmt::Display| MujocoError::Model(error.to_string());
        let xml = mjcf(rig, solids, start);
        let model = MjModel::from_xml_string(&xml).map_err(|error| refused(&error))?;
        let geom = |name: &str| {
            let id = model.name_to_id(MjtObjBase::mjOBJ_GEOM, name).and_then(|id| i32::try_from(id).ok());
            id.ok_or_else(|| refused(&format_args!("it has no geom `{name}`")))
        };
        let platform_geom = geom("platform/body")?;
        let first_links = rig.whiskers.iter().map(|whisker| geom(&format!("{}.0", whisker.name)));
        let first_links = first_links.collect::<Result<Vec<_>, _>>()?;
        let mut data = MjData::try_new(Arc::new(model)).map_err(|error| refused(&error))?;
        data.reset_keyframe(0).map_err(|error| refused(&error))?;
        let sensing = &rig.sensing;
        let samples_per_tick = whole(sensing.sample_rate / sensing.control_rate);
        Ok(Self {
            data,
            rig: rig.clone(),
            steps_per_sample: whole(1.0 / (sensing.sample_rate * rig.physics.step)),
            samples_per_tick,
            samples: Vec::with_capacity(samples_per_tick),
            steps_done: 0,
            sensors: Sensors::new(sensing, seed),
            platform_geom,
            first_links,
            body_touched: false,
        })
    }

    /// Where a whisker (by its index in the rig) is touched, as the simulation has it: the place (m, world frame), half as deep as the
    /// contact, and the length of the shaft from the base to there (m). Of several contacts it is the deepest. No sensor reports
    /// this: it is for who measures with a ruler, never for policies.
    #[must_use]
    pub fn whisker_contact(&self, whisker: usize) -> Option<(Point2, f64)> {
        let links = self.rig.whiskers[whisker].shaft.links;
        let link_of = |geom: &i32| usize::try_from(geom - self.first_links[whisker]).ok().filter(|link| *link < links);
        let contacts = self.data.contact().iter().filter(|contact| contact.dist < 0.0);
        let touching = contacts.filter_map(|contact| Some((contact, contact.geom.iter().find_map(link_of)?)));
        let (contact, link) = touching.min_by(|(a, _), (b, _)| a.dist.total_cmp(&b.dist))?;
        let place = Point2::new(contact.pos[0], contact.pos[1]);
        let (start, direction) = self.link(whisker, link);
        let link_length = self.rig.whiskers[whisker].shaft.link_length();
        let along = (place - start).dot(&unit(direction)).clamp(0.0, link_length);
        Some((place, link as f64 * link_length + along))
    }

    /// The energy (J) in the springs and in the motion of platform and whiskers. No sensor reports this: it is for tests of the simulation.
    #[must_use]
    pub fn energy(&mut self) -> f64 {
        // After a step, what is derived from places and speeds belongs to the state before it.
        self.data.forward();
        self.data.energy_pos();
        self.data.energy_vel();
        self.data.energy().iter().sum()
    }

    /// Where a link of a whisker begins (m, world frame), and its direction (rad).
    fn link(&self, whisker: usize, link: usize) -> (Point2, f64) {
        let positions = self.data.qpos();
        let first: usize = self.rig.whiskers[..whisker].iter().map(|other| 1 + other.shaft.links).sum();
        let Whisker { base_body, direction_body, shaft, .. } = &self.rig.whiskers[whisker];
        let body = Pose { position: Point2::new(positions[0], positions[1]), heading: positions[2] };
        let joints = &positions[3 + first..3 + first + 1 + shaft.links];
        let mut start = body.point_to_world(*base_body);
        let mut direction = body.heading + direction_body + joints[0] + joints[1];
        for turn in &joints[2..2 + link] {
            start += shaft.link_length() * unit(direction);
            direction += turn;
        }
        (start, direction)
    }

    fn time(&self) -> f64 {
        self.steps_done as f64 * self.rig.physics.step
    }

    fn step(&mut self) -> Result<(), Fault> {
        self.data.step();
        self.steps_done += 1;
        // First: after a silent reset, contacts are those of another place.
        self.check_warnings()?;
        for contact in self.data.contact() {
            let (time, depth, limit) = (self.time(), -contact.dist, self.rig.physics.penetration_limit);
            let is_body = contact.geom.contains(&self.platform_geom);
            self.body_touched |= is_body && depth >= 0.0;
            if depth > limit {
                return Err(if is_body {
                    Fault::Crash { time, depth }
                } else {
                    Fault::Penetration { time, depth, limit }
                });
            }
        }
        Ok(())
    }

    /// MuJoCo resets its state when it diverges and goes on as if nothing had been; only its counters tell.
    fn check_warnings(&self) -> Result<(), Fault> {
        let mut warned = self.data.warning().iter().zip(WARNINGS);
        warned.find(|(warning, _)| warning.number > 0).map_or(Ok(()), |(_, cause)| self.diverged(cause))
    }

    fn diverged(&self, cause: &'static str) -> Result<(), Fault> {
        Err(Fault::Diverged { time: self.time(), cause })
    }

    fn sample(&mut self) -> Sample {
        if self.rig.sensing.forces {
            // After a step, what sensors hold belongs to the state before it.
            self.data.forward();
        }
        let positions = self.data.qpos();
        let mut sample = Sample {
            time: self.time(),
            body: Pose { position: Point2::new(positions[0], positions[1]), heading: positions[2] },
            whiskers: Default::default(),
        };
        let mut joint = 3;
        for ((index, whisker), reading) in self.rig.whiskers.iter().enumerate().zip(&mut sample.whiskers) {
            reading.base_angle = self.sensors.read(positions[joint]);
            joint += 1 + whisker.shaft.links;
            if self.rig.sensing.forces {
                let force = &self.data.sensordata()[3 * index..3 * index + 3];
                // MuJoCo reports what the platform does to the shaft.
                let (axial, shear) = (-force[0], -force[1]);
                (reading.axial, reading.shear) =
                    (Some(self.sensors.read_force(axial)), Some(self.sensors.read_force(shear)));
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
        if self.data.qpos().iter().any(|position| !position.is_finite()) {
            self.diverged(WARNINGS[3])?;
        }
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.body_touched
    }
}

/// The version of the linked MuJoCo.
#[must_use]
pub fn engine_version() -> &'static str {
    route_engine_messages();
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
