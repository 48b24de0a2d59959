//! A world with errors of measurement that perception does not know.

use std::collections::VecDeque;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardUniform};

use super::noise::Noise;
use super::sensors::{Sensors, whole};
use super::{Fault, OutOfPlane, Posture, World};
use crate::geometry::{Point2, Pose, Vector2};
use crate::mismatch::{Loss, PoseErrors, SensorErrors, TrueArray};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::{Rig, Sensing};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample};

/// A world whose samples have the errors of a [`TrueArray`], and whose commands are late. It is the same for all
/// simulators.
pub struct Disturbed {
    world: Box<dyn World>,
    array: TrueArray,
    sensors: Sensors,
    noises: Vec<Noise>,
    pose: MeasuredPose,
    random: ChaCha8Rng,
    /// Exact samples as far back as the longest latency, oldest first.
    exact: VecDeque<Sample>,
    /// The longest latency (s).
    memory: f64,
    /// The last readings, for stale ones.
    last: [Reading; MAX_WHISKERS],
    /// The commands of the coming sample periods. It is empty if commands are not late.
    commands: VecDeque<Command>,
    samples: Vec<Sample>,
    samples_per_tick: usize,
    body_touched: bool,
    snapped_off: Vec<bool>,
    out_of_plane: Vec<Option<OutOfPlane>>,
}

/// The errors of measured poses while they are simulated.
struct MeasuredPose {
    errors: PoseErrors,
    noise: (Noise, Noise),
    wander: [Wander; 3],
}

/// A random value with a correlation time, by the exact solution of the Ornstein-Uhlenbeck process.
#[derive(Clone, Copy)]
struct Wander {
    /// The factor by which the value decays in a sample period.
    decay: f64,
    innovation: Noise,
    /// The distribution of the first value.
    initial: Noise,
    value: Option<f64>,
}

impl Disturbed {
    /// The rig that the inner world simulates. Its sensors are exact, because the wrapper adds all errors. If commands
    /// are late, its control period is a sample period.
    #[must_use]
    pub fn inner_rig(array: &TrueArray) -> Rig {
        let mut rig = array.rig.clone();
        let sensing = &mut rig.sensing;
        (sensing.angle_noise, sensing.angle_resolution, sensing.force_noise) = (0.0, 0.0, 0.0);
        if array.command_latency > 0.0 {
            sensing.control_rate = sensing.sample_rate;
        }
        rig
    }

    /// Adds the errors of `array` to a `world` of the [inner rig](Self::inner_rig). `seed` determines all noise.
    #[must_use]
    pub fn new(world: Box<dyn World>, array: TrueArray, seed: u64) -> Self {
        let sensing: &Sensing = &array.rig.sensing;
        let period = sensing.sample_rate.recip();
        let latencies = array.sensors.iter().map(|sensor| sensor.latency).chain([array.pose.latency]);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // Stream 0 of the same seed is the noise of the sensors, and stream 1 the displacement of the start.
        random.set_stream(2);
        let delay = array.command_latency / period;
        Self {
            sensors: Sensors::new(sensing, seed),
            noises: array.sensors.iter().map(|sensor| Noise::new(sensor.noise)).collect(),
            pose: MeasuredPose::new(array.pose, period),
            random,
            exact: VecDeque::new(),
            memory: latencies.fold(0.0, f64::max),
            last: Default::default(),
            commands: if delay > 0.0 { vec![Command::STOP; whole(delay)].into() } else { VecDeque::new() },
            samples: Vec::new(),
            samples_per_tick: whole(sensing.sample_rate / sensing.control_rate),
            body_touched: false,
            snapped_off: vec![false; array.rig.whiskers.len()],
            out_of_plane: vec![None; array.rig.whiskers.len()],
            world,
            array,
        }
    }

    /// Simulates a control period of the inner world.
    fn advance_inner(&mut self, command: &Command) -> Result<usize, Fault> {
        let samples = self.world.advance(command)?;
        let count = samples.len();
        self.exact.extend(samples);
        self.body_touched |= self.world.body_touches();
        for (whisker, snapped_off) in self.snapped_off.iter_mut().enumerate() {
            *snapped_off |= self.world.snapped_off(whisker);
        }
        for (whisker, noted) in self.out_of_plane.iter_mut().enumerate() {
            if let Some(now) = self.world.out_of_plane(whisker) {
                noted.get_or_insert_default().include(now);
            }
        }
        Ok(count)
    }

    /// Measures the exact sample with this index, and keeps it unless it is lost.
    fn measure(&mut self, index: usize) {
        let Some(exact) = self.exact.get(index) else { return };
        let mut sample = Sample { body: self.pose.measure(&self.exact, index, &mut self.random), ..*exact };
        let is_missing = self.array.loss == Loss::Missing && self.is_lost();
        for whisker in 0..self.array.sensors.len() {
            let reading = self.reading(index, whisker);
            let reading = if self.array.loss != Loss::Missing && self.is_lost() {
                self.lost(reading, whisker)
            } else {
                self.last[whisker] = reading;
                reading
            };
            sample.whiskers[whisker] = reading;
        }
        if !is_missing {
            self.samples.push(sample);
        }
    }

    /// The reading of a whisker in the sample with this index.
    fn reading(&mut self, index: usize, whisker: usize) -> Reading {
        let Some(&SensorErrors { gain, cubic, offset, drift, resolution, latency, .. }) =
            self.array.sensors.get(whisker)
        else {
            return Reading::default();
        };
        let at = |of: fn(&Reading) -> Option<f64>| {
            past(&self.exact, index, latency, |sample| of(&sample.whiskers[whisker]).unwrap_or(0.0))
        };
        let time = self.exact.get(index).map_or(0.0, |sample| sample.time) - latency;
        let angle = at(|reading| Some(reading.base_angle));
        let (shear, axial) = (at(|reading| reading.shear), at(|reading| reading.axial));
        let noise = self.noises.get(whisker).copied().unwrap_or_default();
        let mut base_angle = angle * (1.0 + gain + cubic * angle * angle)
            + offset
            + drift * time.max(0.0)
            + noise.draw(&mut self.random);
        if resolution > 0.0 {
            base_angle = (base_angle / resolution).round() * resolution;
        }
        let base_angle = self.sensors.read(base_angle);
        let mut force = |force| self.array.rig.sensing.forces.then(|| self.sensors.read_force(force));
        let axial = force(axial);
        Reading { base_angle, shear: force(shear), axial, true_tip: None }
    }

    /// The reading that a whisker delivers instead of a lost one.
    fn lost(&self, reading: Reading, whisker: usize) -> Reading {
        match self.array.loss {
            Loss::Stale => self.last[whisker],
            Loss::NotANumber | Loss::Missing => Reading {
                base_angle: f64::NAN,
                shear: reading.shear.map(|_| f64::NAN),
                axial: reading.axial.map(|_| f64::NAN),
                true_tip: None,
            },
        }
    }

    fn is_lost(&mut self) -> bool {
        self.array.lost > 0.0 && {
            let share: f64 = StandardUniform.sample(&mut self.random);
            share < self.array.lost
        }
    }

    /// Forgets exact samples that no later sample needs.
    fn forget(&mut self) {
        let Some(newest) = self.exact.back().map(|sample| sample.time) else { return };
        while self.exact.get(1).is_some_and(|second| second.time <= newest - self.memory) {
            self.exact.pop_front();
        }
    }
}

impl World for Disturbed {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.samples.clear();
        self.body_touched = false;
        self.snapped_off.fill(false);
        self.out_of_plane.fill(None);
        let mut count = 0;
        while count < self.samples_per_tick {
            let effective = if self.commands.is_empty() {
                *command
            } else {
                self.commands.push_back(*command);
                self.commands.pop_front().unwrap_or(*command)
            };
            count += self.advance_inner(&effective)?;
        }
        for index in self.exact.len().saturating_sub(count)..self.exact.len() {
            self.measure(index);
        }
        self.forget();
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        self.body_touched
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        self.snapped_off.get(whisker).copied().unwrap_or(false)
    }

    fn out_of_plane(&self, whisker: usize) -> Option<OutOfPlane> {
        self.out_of_plane.get(whisker).copied().flatten()
    }

    fn tip(&self, whisker: usize) -> Point2 {
        self.world.tip(whisker)
    }

    fn posture(&self) -> Option<Posture> {
        self.world.posture()
    }
}

impl MeasuredPose {
    fn new(errors: PoseErrors, period: f64) -> Self {
        let (position, heading) = errors.wander;
        let wander = |spread| Wander::new(spread, period, errors.wander_time);
        Self {
            noise: (Noise::new(errors.noise.0), Noise::new(errors.noise.1)),
            wander: [wander(position), wander(position), wander(heading)],
            errors,
        }
    }

    /// The measured pose of the sample with this index.
    fn measure(&mut self, exact: &VecDeque<Sample>, index: usize, random: &mut ChaCha8Rng) -> Pose {
        let at = |of: fn(&Sample) -> f64| past(exact, index, self.errors.latency, of);
        let pose = [
            at(|sample| sample.body.position.x),
            at(|sample| sample.body.position.y),
            at(|sample| sample.body.heading),
        ];
        let noises = [self.noise.0, self.noise.0, self.noise.1];
        let [x, y, turn] = std::array::from_fn(|part| self.wander[part].next(random) + noises[part].draw(random));
        Pose { position: Point2::new(pose[0], pose[1]) + Vector2::new(x, y), heading: pose[2] + turn }
    }
}

impl Wander {
    /// A wander with this standard deviation and this correlation `time` (s), sampled every `period` (s).
    fn new(spread: f64, period: f64, time: f64) -> Self {
        let decay = if time > 0.0 { math::exp(-period / time) } else { 0.0 };
        Self {
            decay,
            innovation: Noise::new(spread * (1.0 - decay * decay).sqrt()),
            initial: Noise::new(spread),
            value: None,
        }
    }

    fn next(&mut self, random: &mut ChaCha8Rng) -> f64 {
        let value = match self.value {
            Some(value) => self.decay * value + self.innovation.draw(random),
            None => self.initial.draw(random),
        };
        self.value = Some(value);
        value
    }
}

/// A value at the time of the sample with this `index` minus the `latency` (s), interpolated between samples. Before the
/// first sample, its value.
fn past(exact: &VecDeque<Sample>, index: usize, latency: f64, of: impl Fn(&Sample) -> f64) -> f64 {
    let Some(newest) = exact.get(index) else { return 0.0 };
    if latency == 0.0 {
        return of(newest);
    }
    let time = newest.time - latency;
    let after = exact.range(..=index).position(|sample| sample.time >= time).unwrap_or(index);
    match (after.checked_sub(1).and_then(|before| exact.get(before)), exact.get(after)) {
        (Some(before), Some(after)) => {
            let share = (time - before.time) / (after.time - before.time);
            of(before) + share * (of(after) - of(before))
        }
        (None, Some(first)) => of(first),
        (_, None) => of(newest),
    }
}

#[cfg(test)]
mod tests;
