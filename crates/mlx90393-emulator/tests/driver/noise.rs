//! Noise.

use crate::common::{constant, next, started};
use vibrissa_mlx90393::Settings;
use vibrissa_mlx90393_emulator::SensorOptions;

fn counts(seed: u64, address: u8, reads: usize) -> Vec<f64> {
    let options =
        SensorOptions { noise_microtesla: [1.5; 3], seed, field_index: address.into(), ..SensorOptions::default() };
    let (mut bus, mut sensor) = started(constant([0.0; 3]), options, Settings::array());
    bus.clock().advance_ns(10_000_000);
    (0..reads).map(|_| f64::from(next(&mut bus, &mut sensor).unwrap().y.unwrap())).collect()
}

#[test]
fn noise_has_the_given_deviation_and_no_correlation() {
    let counts = counts(1, 0, 4000);
    let mean = counts.iter().sum::<f64>() / 4000.0;
    let variance = counts.iter().map(|count| (count - mean).powi(2)).sum::<f64>() / 4000.0;
    let covariance = counts.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum::<f64>() / 3999.0;
    // 1.5 µT are 10 counts. The bounds are four standard errors.
    assert!(mean.abs() < 0.64, "{mean}");
    assert!((variance.sqrt() - 10.0).abs() < 0.45, "{}", variance.sqrt());
    assert!((covariance / variance).abs() < 0.064, "{covariance}");
}

#[test]
fn the_seed_determines_the_noise_and_sensors_differ() {
    assert_eq!(counts(1, 0, 20), counts(1, 0, 20));
    assert_ne!(counts(1, 0, 20), counts(2, 0, 20));
    assert_ne!(counts(1, 0, 20), counts(1, 1, 20));
}
