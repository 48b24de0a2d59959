#![allow(clippy::unwrap_used, reason = "a test may panic")]
use super::*;
use crate::mismatch::{Mismatch, Property};
use std::sync::{Arc, Mutex};

use vibrissa_runtime::math;

const PERIOD: f64 = 1.0 / 300.0;

/// A world in which everything is linear in time, and which keeps the commands that reach it.
struct Ramp {
    count: u32,
    samples_per_tick: usize,
    commands: Arc<Mutex<Vec<f64>>>,
    samples: Vec<Sample>,
}

/// The base angle (rad) and the pose of the ramp.
fn exact(time: f64) -> (f64, Pose) {
    (1e-4 * time, Pose { position: Point2::new(0.1 * time, -0.2 * time), heading: 0.3 * time })
}

impl World for Ramp {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        self.samples.clear();
        for _ in 0..self.samples_per_tick {
            self.count += 1;
            let time = f64::from(self.count) * PERIOD;
            let (base_angle, body) = exact(time);
            let mut sample = Sample { time, body, whiskers: Default::default() };
            sample.whiskers[..2].fill(Reading { base_angle, ..Reading::default() });
            self.samples.push(sample);
            self.commands.lock().unwrap().push(command.yaw_rate);
        }
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        // In one sample period of the first tick.
        self.count == 4
    }

    fn snapped_off(&self, whisker: usize) -> bool {
        whisker == 1 && self.count == 3
    }

    fn tip(&self, _: usize) -> Point2 {
        Point2::origin()
    }
}

/// The ramp as it is measured with these values, and its commands.
fn disturbed(values: &[(Property, f64)], loss: Loss) -> (Disturbed, Arc<Mutex<Vec<f64>>>) {
    let mut mismatch = Mismatch { loss: Some(loss), ..Mismatch::default() };
    for &(property, value) in values {
        mismatch.common.set(property, value);
    }
    let array = mismatch.array(&Rig::default());
    let commands = Arc::default();
    let inner = Disturbed::inner_rig(&array).sensing;
    let samples_per_tick = whole(inner.sample_rate / inner.control_rate);
    let ramp = Ramp { count: 0, samples_per_tick, commands: Arc::clone(&commands), samples: Vec::new() };
    (Disturbed::new(Box::new(ramp), array, 7), commands)
}

/// The samples of some ticks.
fn samples(world: &mut Disturbed, ticks: usize) -> Vec<Sample> {
    (0..ticks).flat_map(|_| world.advance(&Command::STOP).unwrap().to_vec()).collect()
}

fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    (mean, (values.map(|value| math::square(value - mean)).sum::<f64>() / count).sqrt())
}

#[test]
fn poses_and_readings_are_as_old_as_their_latencies() {
    let latencies = [(Property::PoseLatency, 0.0123), (Property::SensorLatency, 0.05)];
    let (mut world, _) = disturbed(&latencies, Loss::default());
    for sample in samples(&mut world, 100).iter().skip(30) {
        let body = exact(sample.time - 0.0123).1;
        assert!((sample.body.position - body.position).norm() < 1e-12);
        assert!((sample.body.heading - body.heading).abs() < 1e-12);
        assert!((sample.whiskers[1].base_angle - exact(sample.time - 0.05).0).abs() < 1e-15);
    }
    assert!(world.exact.len() < 20, "{} samples are kept", world.exact.len());
}

#[test]
fn a_command_takes_effect_after_its_latency_in_sample_periods() {
    let (mut world, commands) = disturbed(&[(Property::CommandLatency, 7.2 * PERIOD)], Loss::default());
    for yaw_rate in [1.0, 2.0, 3.0] {
        let samples = world.advance(&Command { yaw_rate, ..Command::STOP }).unwrap();
        assert_eq!(samples.len(), 10);
    }
    let expected = [vec![0.0; 7], vec![1.0; 10], vec![2.0; 10], vec![3.0; 3]].concat();
    assert_eq!(*commands.lock().unwrap(), expected);
}

#[test]
fn what_happens_in_one_sample_period_has_happened_in_the_tick() {
    let (mut world, _) = disturbed(&[(Property::CommandLatency, 0.1)], Loss::default());
    world.advance(&Command::STOP).unwrap();
    assert!(world.body_touches() && world.snapped_off(1) && !world.snapped_off(0));
    world.advance(&Command::STOP).unwrap();
    assert!(!world.body_touches() && !world.snapped_off(1));
}

#[test]
fn a_reading_has_gain_cubic_term_offset_drift_and_resolution() {
    let values = [
        (Property::Gain, 0.1),
        (Property::Cubic, 0.2),
        (Property::Offset, 3e-6),
        (Property::Drift, 60e-6),
        (Property::Resolution, 1e-7),
    ];
    let (mut world, _) = disturbed(&values, Loss::default());
    let (mut farthest, mut off) = (0.0_f64, 0.0_f64);
    for sample in samples(&mut world, 300) {
        let angle = exact(sample.time).0;
        let expected = angle * (1.1 + 0.2 * math::square(angle / 1e-3)) + 3e-6 + 1e-6 * sample.time;
        let difference = sample.whiskers[0].base_angle - expected;
        farthest = farthest.max(difference.abs());
        let steps = sample.whiskers[0].base_angle / 1e-7;
        off = off.max((steps - steps.round()).abs());
    }
    assert!(farthest > 0.4e-7 && farthest < 0.5001e-7 && off < 1e-6, "{farthest} {off}");
}

#[test]
fn noise_has_its_standard_deviation_and_no_memory() {
    let values = [(Property::Noise, 2e-6), (Property::PoseNoise, 1e-4), (Property::HeadingNoise, 1e-3)];
    let (mut world, _) = disturbed(&values, Loss::default());
    let samples = samples(&mut world, 2000);
    let errors = |of: fn(&Sample) -> f64| samples.iter().map(of).collect::<Vec<_>>();
    for (errors, spread) in [
        (errors(|sample| sample.whiskers[0].base_angle - exact(sample.time).0), 2e-6),
        (errors(|sample| sample.body.position.x - exact(sample.time).1.position.x), 1e-4),
        (errors(|sample| sample.body.heading - exact(sample.time).1.heading), 1e-3),
    ] {
        let (mean, std) = moments(errors.iter().copied());
        assert!(mean.abs() < 0.03 * spread && (std / spread - 1.0).abs() < 0.03, "{mean} {std} {spread}");
        let product = errors.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / errors.len() as f64;
        assert!((product / (spread * spread)).abs() < 0.03, "{product}");
    }
}

#[test]
fn wander_has_its_standard_deviation_and_its_correlation_time() {
    let values = [(Property::PoseWander, 1e-4), (Property::WanderTime, 0.1)];
    let (mut world, _) = disturbed(&values, Loss::default());
    let errors: Vec<f64> = samples(&mut world, 20_000)
        .iter()
        .map(|sample| sample.body.position.y - exact(sample.time).1.position.y)
        .collect();
    let (_, std) = moments(errors.iter().copied());
    assert!((std / 1e-4 - 1.0).abs() < 0.05, "{std}");
    // 30 samples are the correlation time.
    let correlation = errors.windows(31).map(|span| span[0] * span[30]).sum::<f64>() / errors.len() as f64 / 1e-8;
    assert!((correlation - math::exp(-1.0_f64)).abs() < 0.05, "{correlation}");
}

#[test]
fn a_share_of_the_readings_is_lost_in_the_given_way() {
    let lost = [(Property::Lost, 0.2)];
    let count = 10_000.0;
    let share = |found: usize| (found as f64 / count - 0.2).abs() < 0.02;

    let (mut world, _) = disturbed(&lost, Loss::NotANumber);
    let samples_nan = samples(&mut world, 1000);
    let is_nan = |whisker: usize| move |sample: &&Sample| sample.whiskers[whisker].base_angle.is_nan();
    assert!(share(samples_nan.iter().filter(is_nan(0)).count()));
    assert!(samples_nan.iter().filter(is_nan(0)).filter(is_nan(1)).count() < 1000, "whiskers are independent");

    let (mut world, _) = disturbed(&lost, Loss::Stale);
    let samples_stale = samples(&mut world, 1000);
    let repeats = samples_stale.windows(2).filter(|pair| pair[0].whiskers[0] == pair[1].whiskers[0]).count();
    assert!(share(repeats), "{repeats}");

    let (mut world, _) = disturbed(&lost, Loss::Missing);
    let samples_missing = samples(&mut world, 1000);
    assert!(share(10_000 - samples_missing.len()), "{}", samples_missing.len());
    assert!(samples_missing.iter().all(|sample| sample.whiskers[0].base_angle.is_finite()));
}

#[test]
fn whiskers_without_a_sensor_stay_zero() {
    let (mut world, _) = disturbed(&[(Property::Offset, 1e-5)], Loss::default());
    let samples = samples(&mut world, 1);
    assert!(samples.iter().all(|sample| sample.whiskers[2..].iter().all(|reading| *reading == Reading::default())));
}
