//! The quasi-static simulator as a [`World`].

use crate::geometry::{Point2, Pose, Vector2};
use crate::physics::{Physics, ShaftModel};
use crate::scene::{Overlap, overlap};
use crate::solid::Solid;
use crate::world::{Fault, Posture, SNAP_OFF_SPEED, World};
use crate::world::{Sensors, raised, whole};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

use super::platform_dynamics::PlatformDynamics;
use super::surface::Surfaces;
use super::whisker::{EquilibriumError, QuasiStaticWhisker};

/// The reasons for which a quasi-static simulation cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum QuasiStaticError {
    /// Whiskers cannot bend out of the plane.
    #[error(
        "the quasi-static simulator is planar, and `physics.whiskers` is `spatial`; leave it out, or use the simulator `mujoco`"
    )]
    Spatial,
    /// The rig overlaps or touches a solid at the start.
    #[error("{part} touches or overlaps a solid at the start; choose another start")]
    Start {
        /// The affected part of the rig.
        part: String,
    },
}

/// A simulation of a rig among solids. Its whiskers are in static equilibrium at every sample.
#[derive(Debug)]
pub struct QuasiStaticWorld {
    rig: Rig,
    penetration_limit: f64,
    surfaces: Surfaces,
    platform: PlatformDynamics,
    whiskers: Vec<QuasiStaticWhisker>,
    period: f64,
    samples_per_tick: usize,
    samples: Vec<Sample>,
    samples_done: u64,
    sensors: Sensors,
    body_touched: bool,
    /// For every whisker, true if it snapped off since the last tick.
    snapped_off: Vec<bool>,
}

impl QuasiStaticWorld {
    /// Builds the simulation with the platform at rest at `start`. `seed` determines the noise of the sensors.
    ///
    /// # Errors
    /// [`QuasiStaticError`] if the simulator does not support the scene.
    pub fn new(
        rig: &Rig,
        physics: &Physics,
        solids: &[Solid],
        start: Pose,
        seed: u64,
    ) -> Result<Self, QuasiStaticError> {
        if physics.shafts == ShaftModel::SpatialChain {
            return Err(QuasiStaticError::Spatial);
        }
        if let Some(overlap) = solids.iter().find_map(|solid| overlap(rig, &start, solid.surface())) {
            let part = match overlap {
                Overlap::Platform => "the platform".to_owned(),
                Overlap::Whisker(index) => format!("the whisker `{}`", rig.whiskers[index].name),
            };
            return Err(QuasiStaticError::Start { part });
        }
        let sensing = &rig.sensing;
        let samples_per_tick = whole(sensing.sample_rate / sensing.control_rate);
        let base = |whisker: &vibrissa_runtime::rig::Whisker| Pose {
            position: start.point_to_world(whisker.base_body),
            heading: start.heading + whisker.direction_body,
        };
        Ok(Self {
            surfaces: Surfaces::new(solids),
            platform: PlatformDynamics::at_rest(start, &rig.platform, physics),
            whiskers: rig
                .whiskers
                .iter()
                .map(|whisker| QuasiStaticWhisker::new(whisker, physics.friction, base(whisker)))
                .collect(),
            period: sensing.sample_rate.recip(),
            samples_per_tick,
            samples: Vec::with_capacity(samples_per_tick),
            samples_done: 0,
            sensors: Sensors::new(sensing, seed),
            body_touched: false,
            snapped_off: vec![false; rig.whiskers.len()],
            rig: rig.clone(),
            penetration_limit: physics.penetration_limit,
        })
    }

    fn time(&self) -> f64 {
        self.samples_done as f64 * self.period
    }

    fn step(&mut self, command: &Command) -> Result<(), Fault> {
        let centre = self.platform.pose.position;
        let (mut force, mut moment) = (Vector2::zeros(), 0.0);
        for whisker in &self.whiskers {
            force += whisker.force();
            moment += (whisker.base() - centre).perp(&whisker.force());
        }
        let touch = self.platform.step(command, (force, moment), self.period, &self.surfaces);
        self.samples_done += 1;
        let (body, time) = (self.platform.pose, self.time());
        if !body.is_finite() {
            return Err(Fault::Diverged { time, cause: "a command is too large or not a number" });
        }
        self.body_touched |= touch.is_some();
        let limit = self.penetration_limit;
        if let Some(depth) = touch.filter(|&depth| depth > limit) {
            return Err(Fault::Crash { time, depth });
        }
        let parts = self.rig.whiskers.iter().zip(&mut self.snapped_off);
        for (whisker, (part, snapped_off)) in self.whiskers.iter_mut().zip(parts) {
            let position: Point2 = body.point_to_world(part.base_body);
            let base = Pose { position, heading: body.heading + part.direction_body };
            whisker.follow(base, self.period, &self.surfaces, limit).map_err(|error| match error {
                // There is no step of the simulation that could be shorter.
                EquilibriumError::Penetration(depth) => Fault::Penetration { time, depth, limit, shorter_times: None },
                // The base is a part of the platform.
                EquilibriumError::PassedThrough(depth) => Fault::Crash { time, depth },
                EquilibriumError::NotConverged => {
                    Fault::Diverged { time, cause: "the equilibrium of a whisker did not converge; reduce the speed" }
                }
            })?;
            *snapped_off |= whisker.relative_motion() > SNAP_OFF_SPEED * self.period;
        }
        Ok(())
    }

    fn sample(&mut self) -> Sample {
        let mut sample = Sample { time: self.time(), body: self.platform.pose, whiskers: Default::default() };
        for (whisker, reading) in self.whiskers.iter().zip(&mut sample.whiskers) {
            reading.base_angle = self.sensors.read(whisker.base_angle());
            if self.rig.sensing.forces {
                let force = whisker.force_base();
                (reading.axial, reading.shear) =
                    (Some(self.sensors.read_force(force.x)), Some(self.sensors.read_force(force.y)));
            }
        }
        sample
    }
}

impl World for QuasiStaticWorld {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.body_touched = false;
        self.snapped_off.fill(false);
        self.samples.clear();
        for _ in 0..self.samples_per_tick {
            self.step(command)?;
            let sample = self.sample();
            self.samples.push(sample);
        }
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.body_touched
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.snapped_off[whisker]
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.whiskers[whisker].tip()
    }

    fn posture(&self) -> Option<Posture> {
        let shaft = |whisker: &QuasiStaticWhisker| {
            std::iter::once(whisker.base()).chain(whisker.ends()).map(|end| raised(end, 0.0)).collect()
        };
        Some(Posture { body: self.platform.pose, shafts: self.whiskers.iter().map(shaft).collect() })
    }
}
