//! Motion of an array between rests, and the mean readings of a rest.

use std::f64::consts::PI;

use vibrissa_runtime::calibration::TouchNoise;
use vibrissa_runtime::math;
use vibrissa_runtime::motion::ServoLead;
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Sample};

use vibrissa_world::geometry::{Point2, Pose, Vector2};
use vibrissa_world::world::{Fault, World};

/// Moves a platform by its measured poses, with a constant heading.
pub(super) struct ArrayPilot<'w> {
    world: &'w mut dyn World,
    /// Control rate (Hz).
    rate: f64,
    /// Rate of the approach to a position (1/s).
    gain: f64,
    /// Speed limit (m/s).
    speed: f64,
    heading: f64,
    body: Pose,
    /// Measures the servos by the poses. `None` for a rig that cannot perceive.
    perception: Option<Perception>,
    /// Lets the platform move as one whose servos are those of the rig. Slower ones would overshoot.
    servo_lead: ServoLead,
    ticks: u64,
    /// Standard deviations of the measured position (m, of each coordinate) and heading (rad).
    pub(super) noise: TouchNoise,
    /// Mean base angles (rad) of the rest at the start, and the standard deviations of their readings.
    first_base_angles: [f64; MAX_WHISKERS],
    first_noises: [f64; MAX_WHISKERS],
}

/// The mean of the samples of a rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rest {
    /// Time of its middle (s).
    pub(super) time: f64,
    /// Pose of the platform.
    pub(super) body: Pose,
    /// Standard deviations of the measured position (m, of each coordinate) and heading (rad).
    noise: TouchNoise,
    /// Base angles (rad).
    base_angles: [Moments; MAX_WHISKERS],
}

/// Speed between touches (m/s), and the highest rate of the approach (1/s).
const SPEED: f64 = 0.2;
const GAIN: f64 = 4.0;
/// Distance (m) at which a motion between touches ends, and one to a touch.
const PASSED: f64 = 1e-3;
const ARRIVED: f64 = 0.3e-3;
/// Distance (m) from the position of a touch from which the platform approaches it slowly.
const LAST_WAY: f64 = 8e-3;
/// Rate of an approach that presses a whisker (1/s). It does not overshoot with slow servos, so that friction keeps its
/// direction.
const PRESS_GAIN: f64 = 2.0;
/// Time limit of a motion beyond that at full speed, in units of the inverse rate. The force of a whisker keeps the
/// platform at a distance.
const PATIENCE: f64 = 5.0;
/// Time until whisker and platform are at rest (s).
pub(super) const SETTLING: f64 = 0.4;
/// Time (s) of a window of readings. A whisker has settled if the means of two successive windows differ by no more than this (rad) or
/// than this many standard deviations of their noise. And the longest time (s) until then.
const WINDOW: f64 = 0.2;
const SETTLED: f64 = 5e-8;
const CERTAIN: f64 = 3.0;
const PATIENCE_AT_REST: f64 = 10.0;
/// Duration (s) of a rest in the air: two periods of the slowest first mode, 4 Hz. Hann's window is free of the swing from there on.
const IN_AIR: f64 = 0.5;
/// Least phase of a sample in that window, so that each has a weight.
const LEAST_PHASE: f64 = 1e-3;
/// Duration (s) of the rest that shows the noise of poses.
const FIRST_REST: f64 = 20.0;
/// Time of the motions of a touch (s), and the limits of the time of its rest.
const MOTIONS: f64 = 5.0;
const RESTS: (f64, f64) = (0.5, 3.0);

impl<'w> ArrayPilot<'w> {
    /// Takes over a platform at rest.
    pub(super) fn new(world: &'w mut dyn World, rig: &Rig) -> Result<Self, Fault> {
        let mut pilot = Self {
            world,
            rate: rig.sensing.control_rate,
            gain: GAIN.min(0.25 / rig.platform.servo),
            perception: Perception::new(rig, &[], &[]).ok(),
            servo_lead: ServoLead::new(rig),
            speed: SPEED.min(rig.platform.speed_limit),
            heading: 0.0,
            body: Pose::UNKNOWN,
            ticks: 0,
            noise: TouchNoise::default(),
            first_base_angles: [0.0; MAX_WHISKERS],
            first_noises: [f64::INFINITY; MAX_WHISKERS],
        };
        pilot.settle(0.0, |_| Command::STOP)?;
        let rest = pilot.rest(FIRST_REST, |_| Command::STOP)?;
        (pilot.heading, pilot.noise) = (rest.body.heading, rest.noise);
        pilot.first_base_angles = rest.base_angles.map(|angle| angle.mean);
        pilot.first_noises = rest.base_angles.map(|angle| angle.variance().sqrt());
        Ok(pilot)
    }

    /// Mean base angle (rad) of a whisker in the rest at the start, in the air.
    pub(super) fn first_base_angle(&self, whisker: usize) -> f64 {
        self.first_base_angles[whisker]
    }

    /// Time since the start (s).
    pub(super) fn time(&self) -> f64 {
        self.ticks as f64 / self.rate
    }

    /// The heading (rad) that the platform keeps.
    pub(super) fn heading(&self) -> f64 {
        self.heading
    }

    /// Position of the platform (m, world frame), as it was last measured.
    pub(super) fn position(&self) -> Point2 {
        self.body.position
    }

    /// Time of the rest of a touch (s), if the whole touch has a certain time (s).
    pub(super) fn rest_time(touch: f64) -> f64 {
        (touch - MOTIONS).clamp(RESTS.0, RESTS.1)
    }

    /// Moves past a position (m, world frame).
    pub(super) fn go(&mut self, position: Point2) -> Result<(), Fault> {
        self.approach(position, self.gain, PASSED)
    }

    /// Moves to a position (m, world frame) without overshoot, and rests there for a time (s). The platform keeps the
    /// position against the force of a whisker, whose readings change by so much per displacement (rad/m).
    pub(super) fn press(&mut self, position: Point2, time: f64, by_displacement: f64) -> Result<Rest, Fault> {
        let way = position - self.body.position;
        if let Some(ahead) = way.try_normalize(LAST_WAY) {
            self.approach(position - LAST_WAY * ahead, self.gain, PASSED)?;
        }
        let gain = PRESS_GAIN.min(self.gain);
        self.approach(position, gain, ARRIVED)?;
        // The platform follows its measured pose, so the whisker feels the errors of poses.
        self.settle(self.noise.position * by_displacement, |pilot| pilot.towards(position, gain))?;
        self.rest(time, |pilot| pilot.towards(position, gain))
    }

    fn approach(&mut self, position: Point2, gain: f64, near: f64) -> Result<(), Fault> {
        let distance = |pilot: &Self| (position - pilot.body.position).norm();
        let end = self.time() + distance(self) / self.speed + PATIENCE / gain;
        while self.time() < end && distance(self) > near {
            let command = self.towards(position, gain);
            self.tick(&command, |_| ())?;
        }
        Ok(())
    }

    /// The command towards a position (m, world frame).
    fn towards(&self, position: Point2, gain: f64) -> Command {
        let way = position - self.body.position;
        let speed = (gain * way.norm()).min(self.speed);
        let velocity_world = way.try_normalize(0.0).map_or(Vector2::zeros(), |ahead| speed * ahead);
        Command { velocity_world, yaw_rate: gain * (self.heading - self.body.heading) }
    }

    /// Moves on at a constant velocity (m/s, world frame) for a time (s). The mean reading is that at the mean pose.
    pub(super) fn slide(&mut self, velocity: Vector2, time: f64) -> Result<Rest, Fault> {
        self.rest(time, |pilot| Command {
            velocity_world: velocity,
            yaw_rate: pilot.gain * (pilot.heading - pilot.body.heading),
        })
    }

    /// Executes commands for a time (s), each from the time since the start of it (s). `look` receives each sample.
    pub(super) fn watch(
        &mut self,
        time: f64,
        command: impl Fn(&Self, f64) -> Vector2,
        mut look: impl FnMut(&Sample),
    ) -> Result<(), Fault> {
        let start = self.time();
        while self.time() - start < time {
            let velocity_world = command(self, self.time() - start);
            let yaw_rate = self.gain * (self.heading - self.body.heading);
            self.tick(&Command { velocity_world, yaw_rate }, &mut look)?;
        }
        Ok(())
    }

    /// Rests in the air.
    pub(super) fn rest_in_air(&mut self) -> Result<Rest, Fault> {
        self.settle(0.0, |_| Command::STOP)?;
        self.rest(IN_AIR, |_| Command::STOP)
    }

    /// One tick. `look` receives each sample. A pose that is not a number keeps the last one.
    fn tick(&mut self, command: &Command, mut look: impl FnMut(&Sample)) -> Result<(), Fault> {
        let command = match &mut self.perception {
            Some(perception) => {
                let command = self.servo_lead.next(*command, perception.servos());
                perception.command(command);
                command
            }
            None => *command,
        };
        let samples = self.world.advance(&command)?;
        if let Some(perception) = &mut self.perception {
            perception.update(samples);
        }
        for sample in samples {
            look(sample);
            if sample.body.is_finite() {
                self.body = sample.body;
            }
        }
        self.ticks += 1;
        Ok(())
    }

    /// Number of ticks in a time (s).
    fn ticks(&self, time: f64) -> u32 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let ticks = (time * self.rate).ceil() as u32;
        ticks
    }

    /// Executes commands until all readings have settled: no whisker swings or creeps, and the platform has arrived. Readings that
    /// change by `moving` (rad, standard deviation) have settled.
    fn settle(&mut self, moving: f64, command: impl Fn(&Self) -> Command) -> Result<(), Fault> {
        for _ in 0..self.ticks(SETTLING) {
            self.tick(&command(self), |_| ())?;
        }
        let until = self.time() + PATIENCE_AT_REST;
        let mut before: Option<[Moments; MAX_WHISKERS]> = None;
        while self.time() < until {
            let mut now: [Moments; MAX_WHISKERS] = Default::default();
            for _ in 0..self.ticks(WINDOW) {
                self.tick(&command(self), |sample| {
                    for (mean, reading) in now.iter_mut().zip(&sample.whiskers) {
                        mean.add(reading.base_angle, 1.0);
                    }
                })?;
            }
            let is_settled = |before: &[Moments; MAX_WHISKERS]| {
                let noises = &self.first_noises;
                before.iter().zip(&now).zip(noises).all(|((before, now), noise)| {
                    let deviation = math::hypot(noise * (2.0 / now.count.max(1.0)).sqrt(), moving);
                    (now.mean - before.mean).abs() <= math::max(SETTLED, CERTAIN * deviation)
                        && now.variance() <= math::square(SETTLED) + 2.0 * noise * noise + math::square(moving)
                })
            };
            if before.as_ref().is_some_and(is_settled) {
                break;
            }
            before = Some(now);
        }
        Ok(())
    }

    /// Executes commands and averages the samples of a time (s). Values that are not numbers are left out. The weights are those of
    /// Hann's window, because of a whisker that still swings the mean over a window with abrupt ends depends on its phase.
    fn rest(&mut self, time: f64, command: impl Fn(&Self) -> Command) -> Result<Rest, Fault> {
        let (start, count) = (self.time(), self.ticks(time));
        let (mut poses, mut angles): (Vec<(Pose, f64)>, [Moments; MAX_WHISKERS]) = (Vec::new(), Default::default());
        let (mut first, duration) = (None, f64::from(count) / self.rate);
        for _ in 0..count {
            self.tick(&command(self), |sample| {
                let passed = sample.time - *first.get_or_insert(sample.time);
                let weight = math::square(math::sin(PI * (passed / duration).clamp(LEAST_PHASE, 1.0 - LEAST_PHASE)));
                poses.extend(sample.body.is_finite().then_some((sample.body, weight)));
                for (mean, reading) in angles.iter_mut().zip(&sample.whiskers) {
                    mean.add(reading.base_angle, weight);
                }
            })?;
        }
        let coordinate = |value: fn(&Pose) -> f64| {
            let mut mean = Moments::default();
            for (pose, weight) in &poses {
                mean.add(value(pose), *weight);
            }
            mean
        };
        let [x, y, heading] =
            [|pose: &Pose| pose.position.x, |pose: &Pose| pose.position.y, |pose: &Pose| pose.heading].map(coordinate);
        Ok(Rest {
            time: 0.5 * (start + self.time()),
            body: Pose { position: Point2::new(x.mean, y.mean), heading: heading.mean },
            noise: TouchNoise {
                position: (0.5 * (x.variance() + y.variance())).sqrt(),
                heading: heading.variance().sqrt(),
            },
            base_angles: angles,
        })
    }
}

impl Rest {
    /// Mean base angle (rad) of a whisker by its index, and its standard deviation.
    pub(super) fn base_angle(&self, whisker: usize) -> (f64, f64) {
        self.base_angles.get(whisker).map(|angle| (angle.mean, angle.deviation_of_mean())).unwrap_or_default()
    }
}

/// Weighted mean and sum of squared deviations, by the method of West (Communications of the ACM 22, 1979).
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    count: f64,
    weight: f64,
    squared_weights: f64,
    mean: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, value: f64, weight: f64) {
        if value.is_finite() && weight > 0.0 {
            self.count += 1.0;
            self.weight += weight;
            self.squared_weights += math::square(weight);
            let off = value - self.mean;
            self.mean += weight / self.weight * off;
            self.squares += weight * off * (value - self.mean);
        }
    }

    /// Variance of a value, without bias for a large count.
    fn variance(&self) -> f64 {
        if self.count < 2.0 { 0.0 } else { self.squares / self.weight * self.count / (self.count - 1.0) }
    }

    /// Standard deviation of the mean of independent values.
    fn deviation_of_mean(&self) -> f64 {
        if self.weight > 0.0 { (self.variance() * self.squared_weights).sqrt() / self.weight } else { 0.0 }
    }
}
