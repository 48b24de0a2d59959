//! A rig among solids, simulated by MuJoCo.

use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{Command, Sample};
use vibrissa_world::geometry::{Point2, Pose, unit};
use vibrissa_world::physics::{MIN_INERTIA, Physics, ShaftModel, light_shaft};
use vibrissa_world::solid::{PartsError, Solid};
use vibrissa_world::world::{Fault, OutOfPlane, Posture, SNAP_OFF_SPEED, World};
use vibrissa_world::world::{Sensors, raised, whole};

use super::engine::Engine;
use super::library::LibraryError;
use super::messages::{WARNINGS, prepare_engine};
use super::model_selector::ModelSelector;
use super::plugin::{PluginError, load_cable_plugin};

/// The initial capacity for pairs of a pruned model.
const INITIAL_CAPACITY: usize = 64;

/// The reason why a MuJoCo simulation cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum MujocoError {
    /// MuJoCo rejected the generated model.
    #[error("MuJoCo refused the generated model: {0}; `vibrissa inspect mjcf` prints the model")]
    Model(String),
    /// A shaft is so light that MuJoCo's least inertia would change its dynamics.
    #[error(
        "the links of whisker `{whisker}` are too light to be simulated by MuJoCo: its least moment of inertia of a link, \
         {MIN_INERTIA:.0e} kg m^2, adds {:.0} % to that of the whisker about its base; use fewer `links` or a thicker shaft, or use the \
         simulator `quasistatic`, which has no inertia",
        100.0 * share
    )]
    Light {
        /// The whisker.
        whisker: String,
        /// The share of the whisker's moment of inertia about its base that is added.
        share: f64,
    },
    /// A solid is too large to be simulated.
    #[error(transparent)]
    Parts(#[from] PartsError),
    /// A solid is too large to be drawn, whatever simulates it.
    #[error("MuJoCo cannot draw the scene: {0}")]
    Undrawable(PartsError),
    /// The rig has cables, and their plugin is not available.
    #[error(transparent)]
    Plugin(#[from] PluginError),
    /// MuJoCo's library cannot be used.
    #[error(transparent)]
    Library(#[from] LibraryError),
}

/// A rig among solids, simulated by MuJoCo.
///
/// The same rig, solids, start, seed and commands give bit-identical samples.
pub struct MujocoWorld {
    engine: Engine,
    model_selector: ModelSelector,
    rig: Rig,
    physics: Physics,
    steps_per_sample: usize,
    /// The number of steps that a calm step replaces.
    steps_in_calm: usize,
    samples_per_tick: usize,
    samples: Vec<Sample>,
    steps_done: u64,
    sensors: Sensors,
    body_touched: bool,
    /// For every whisker, true if it snapped off since the last tick.
    snapped_off: Vec<bool>,
    /// For every whisker of a spatial simulation, the distance of its tip from the plane since the last tick.
    out_of_plane: Vec<OutOfPlane>,
}

impl MujocoWorld {
    /// Builds the simulation with the platform at rest at `start`. `seed` determines the noise of the sensors. The
    /// model is complete: it contains all parts and links at all times.
    ///
    /// # Errors
    /// [`MujocoError`] if a solid is too large for MuJoCo, or if MuJoCo rejects the model.
    pub fn new(rig: &Rig, physics: &Physics, solids: &[Solid], start: Pose, seed: u64) -> Result<Self, MujocoError> {
        Self::with(rig, physics, solids, start, seed, None)
    }

    /// Builds a pruned simulation. Its model contains only parts and links that can touch.
    ///
    /// # Errors
    /// [`MujocoError`] if a solid is too large for MuJoCo, or if MuJoCo rejects the model.
    pub fn pruned(rig: &Rig, physics: &Physics, solids: &[Solid], start: Pose, seed: u64) -> Result<Self, MujocoError> {
        Self::with(rig, physics, solids, start, seed, Some(INITIAL_CAPACITY))
    }

    fn with(
        rig: &Rig,
        physics: &Physics,
        solids: &[Solid],
        start: Pose,
        seed: u64,
        capacity: Option<usize>,
    ) -> Result<Self, MujocoError> {
        prepare_engine()?;
        let rig = &rig.vibrating();
        for whisker in &rig.whiskers {
            if let Some(share) = light_shaft(&whisker.shaft) {
                return Err(MujocoError::Light { whisker: whisker.name.clone(), share });
            }
        }
        if physics.shafts == ShaftModel::Cable {
            load_cable_plugin()?;
        }
        let mut model_selector = ModelSelector::new(rig, physics, solids, capacity)?;
        let engine = model_selector.initial_model(rig, start)?;
        let sensing = &rig.sensing;
        let samples_per_tick = whole(sensing.sample_rate / sensing.control_rate);
        let steps_per_sample = whole(1.0 / (sensing.sample_rate * physics.step));
        Ok(Self {
            engine,
            model_selector,
            steps_per_sample,
            steps_in_calm: physics.steps_in_calm(steps_per_sample),
            samples_per_tick,
            samples: Vec::with_capacity(samples_per_tick),
            steps_done: 0,
            sensors: Sensors::new(sensing, seed),
            body_touched: false,
            snapped_off: vec![false; rig.whiskers.len()],
            out_of_plane: match physics.shafts {
                ShaftModel::SpatialChain => vec![OutOfPlane::default(); rig.whiskers.len()],
                ShaftModel::Chain | ShaftModel::Cable => Vec::new(),
            },
            rig: rig.clone(),
            physics: physics.clone(),
        })
    }

    /// The deepest simulated contact of a whisker, by its index in the rig. Returns the contact point (m, world frame)
    /// at half of the penetration depth, and its distance from the base along the shaft (m). No sensor reports this. It
    /// serves for measurements, never for policies.
    #[must_use]
    pub fn whisker_contact(&self, whisker: usize) -> Option<(Point2, f64)> {
        let shaft = &self.rig.whiskers[whisker].shaft;
        let (place, link) = self.engine.deepest(whisker, shaft.links)?;
        let along = self.engine.links(&self.rig, whisker).nth(link)?.along(place).clamp(0.0, shaft.link_length());
        Some((place, link as f64 * shaft.link_length() + along))
    }

    /// The energy (J) of springs, platform and whiskers. No sensor reports this. It serves for tests of the simulation.
    ///
    /// # Errors
    /// [`Fault::Model`] if MuJoCo rejects a model with a larger capacity.
    pub fn energy(&mut self) -> Result<f64, Fault> {
        self.refresh()?;
        Ok(self.engine.energy())
    }

    /// The position of a whisker's tip (m, world frame) and its height above the plane of the bases (m).
    fn tip_and_height(&self, whisker: usize) -> (Point2, f64) {
        let Whisker { base_body, direction_body, shaft, .. } = &self.rig.whiskers[whisker];
        let body = self.engine.body();
        let rigid = (body.point_to_world(*base_body), body.heading + direction_body);
        let last = self.engine.links(&self.rig, whisker).last();
        last.map_or_else(|| (rigid.0 + shaft.length * unit(rigid.1), 0.0), |link| link.point(shaft.link_length()))
    }

    /// Notes the distances of the tips from the plane.
    fn watch_heights(&mut self) {
        for whisker in 0..self.out_of_plane.len() {
            let distance = self.tip_and_height(whisker).1.abs();
            let slips = distance > 0.5 * self.physics.object_height;
            self.out_of_plane[whisker].include(OutOfPlane { distance, slips });
        }
    }

    fn time(&self) -> f64 {
        self.steps_done as f64 * self.physics.step
    }

    /// Simulates one step that is as long as `steps` regular steps.
    fn step(&mut self, steps: usize) -> Result<(), Fault> {
        self.engine.step(steps as f64 * self.physics.step);
        self.steps_done += steps as u64;
        // This check comes first: after a silent reset, the contacts belong to another state.
        self.engine.warning().map_or(Ok(()), |cause| self.diverged(cause))?;
        for (depth, is_body) in self.engine.contacts() {
            let (time, limit) = (self.time(), self.physics.penetration_limit);
            self.body_touched |= is_body && depth >= 0.0;
            if depth > limit {
                return Err(if is_body {
                    Fault::Crash { time, depth }
                } else {
                    Fault::Penetration { time, depth, limit, shorter_times: self.physics.shorter_times() }
                });
            }
        }
        Ok(())
    }

    /// True if no whisker moves fast and the body touches nothing. A calm whisker moves at most a third of a millimetre
    /// in a step of 3.3 ms.
    fn is_calm(&self) -> bool {
        !self.body_touched && (0..self.rig.whiskers.len()).all(|whisker| !self.is_snapping_off(whisker))
    }

    fn is_snapping_off(&self, whisker: usize) -> bool {
        self.engine.speed(&self.rig, whisker) >= SNAP_OFF_SPEED
    }

    fn diverged(&self, cause: &'static str) -> Result<(), Fault> {
        Err(Fault::Diverged { time: self.time(), cause })
    }

    /// Simulates one sample period.
    fn simulate_sample(&mut self) -> Result<(), Fault> {
        let mut done = 0;
        while done < self.steps_per_sample {
            if self.steps_in_calm == 1 || !self.try_calm_step()? {
                for _ in 0..self.steps_in_calm {
                    self.model_selector.update_pairs(&self.rig, &mut self.engine)?;
                    self.step(1)?;
                    for whisker in 0..self.snapped_off.len() {
                        self.snapped_off[whisker] |= self.is_snapping_off(whisker);
                    }
                }
            }
            done += self.steps_in_calm;
        }
        Ok(())
    }

    /// Replaces several steps by one, unless a whisker is not calm before or after it. After a snap-off, a whisker
    /// reaches metres per second and the next surface within a few milliseconds. Therefore the state after the step
    /// decides. Returns true if the step was accepted.
    fn try_calm_step(&mut self) -> Result<bool, Fault> {
        if !self.is_calm() {
            return Ok(false);
        }
        self.model_selector.update_pairs(&self.rig, &mut self.engine)?;
        self.engine.save();
        self.step(self.steps_in_calm)?;
        let is_calm = self.is_calm();
        if !is_calm {
            self.engine.restore();
            self.steps_done -= self.steps_in_calm as u64;
        }
        Ok(is_calm)
    }

    /// Refreshes the engine for the pairs that are near after the last step, however large that step was.
    fn refresh(&mut self) -> Result<(), Fault> {
        self.model_selector.update_pairs(&self.rig, &mut self.engine)?;
        self.engine.refresh();
        Ok(())
    }

    fn sample(&mut self) -> Result<Sample, Fault> {
        if self.rig.sensing.forces {
            self.refresh()?;
        }
        let mut sample = Sample { time: self.time(), body: self.engine.body(), whiskers: Default::default() };
        for (index, reading) in (0..self.rig.whiskers.len()).zip(&mut sample.whiskers) {
            reading.base_angle = self.sensors.read(self.engine.angles(index).next().map_or(0.0, |[angle, _]| angle));
            if self.rig.sensing.forces {
                let (axial, shear) = self.engine.base_forces(index);
                (reading.axial, reading.shear) =
                    (Some(self.sensors.read_force(axial)), Some(self.sensors.read_force(shear)));
            }
        }
        Ok(sample)
    }
}

impl World for MujocoWorld {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.model_selector.select(&self.rig, &mut self.engine, command)?;
        self.engine.command(command.velocity_world, command.yaw_rate);
        self.body_touched = false;
        self.snapped_off.fill(false);
        self.out_of_plane.fill(OutOfPlane::default());
        self.samples.clear();
        for _ in 0..self.samples_per_tick {
            self.simulate_sample()?;
            let sample = self.sample()?;
            self.samples.push(sample);
            self.watch_heights();
        }
        if !self.engine.is_finite() {
            self.diverged(WARNINGS[3])?;
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
        self.tip_and_height(whisker).0
    }

    fn posture(&self) -> Option<Posture> {
        let body = self.engine.body();
        let shaft = |(index, whisker): (usize, &Whisker)| {
            let mut points = vec![raised(body.point_to_world(whisker.base_body), 0.0)];
            let length = whisker.shaft.link_length();
            let ends = self.engine.links(&self.rig, index).map(|link| link.point(length));
            points.extend(ends.map(|(end, height)| raised(end, height)));
            if points.len() == 1 {
                let (tip, height) = self.tip_and_height(index);
                points.push(raised(tip, height));
            }
            points
        };
        Some(Posture { body, shafts: self.rig.whiskers.iter().enumerate().map(shaft).collect() })
    }

    fn out_of_plane(&self, whisker: usize) -> Option<OutOfPlane> {
        self.out_of_plane.get(whisker).copied()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use vibrissa_world::geometry::{Vector2, circle, polygon};

    /// The right whisker is moved along a disk and over the teeth of a comb behind it, and back. It snaps off from
    /// tooth to tooth.
    #[test]
    fn models_that_are_replaced_within_a_tick_for_more_room_change_no_bit() {
        let tooth =
            |y: f64| polygon(&[(0.11, y), (0.3, y), (0.3, y + 2e-3), (0.11, y + 2e-3)].map(|(x, y)| Point2::new(x, y)));
        let outlines = std::iter::once(circle(Point2::new(0.2, 0.15), 0.1));
        let outlines = outlines.chain((0..10).map(|index| tooth(0.3 + 0.012 * f64::from(index))));
        let solids: Vec<_> = outlines.map(|outline| Solid::inside(outline.unwrap()).unwrap()).collect();
        let start = Pose { position: Point2::new(0.0, 0.0), heading: FRAC_PI_2 };
        let mut rig = Rig::default();
        let physics = Physics { penetration_limit: 5e-3, ..Physics::default() };
        for forces in [false, true] {
            rig.sensing.forces = forces;
            let run = |capacity| {
                let mut world = MujocoWorld::with(&rig, &physics, &solids, start, 0, capacity).unwrap();
                let mut readings = Vec::new();
                for (ticks, speed) in [(120, 0.12), (60, -0.12)] {
                    let command = Command { velocity_world: Vector2::new(0.0, speed), yaw_rate: 0.0 };
                    for _ in 0..ticks {
                        for sample in world.advance(&command).unwrap() {
                            let Pose { position, heading } = sample.body;
                            let whiskers = sample.whiskers.iter();
                            let forces = |force: Option<f64>| force.unwrap_or_default();
                            let of_whisker = whiskers.flat_map(|r| [r.base_angle, forces(r.axial), forces(r.shear)]);
                            readings.extend([position.x, position.y, heading].into_iter().chain(of_whisker));
                        }
                    }
                }
                (readings.into_iter().map(f64::to_bits).collect::<Vec<_>>(), world.engine.scope.capacity())
            };
            let (whole, _) = run(None);
            let (grown, capacity) = run(Some(1));
            assert!(capacity > Some(2), "the capacity was never exceeded: {capacity:?}");
            let first = whole.iter().zip(&grown).position(|(a, b)| a != b);
            assert!(first.is_none(), "forces: {forces}; number {first:?} of {}", whole.len());
        }
    }
}
