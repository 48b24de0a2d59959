//! Noise.

use crate::common::{ADDRESS, bus, constant, next};
use vibrissa_mlx90393::{Address, Sensor, Settings};
use vibrissa_mlx90393_emulator::SensorOptions;

/// Counts of a sensor with a noise of 10 counts.
fn counts(seed: u64, field_index: usize, address: u8, reads: usize) -> Vec<f64> {
    let noise_microtesla = [1.5; 3];
    let options = SensorOptions { noise_microtesla, seed, field_index, address, ..SensorOptions::default() };
    let mut bus = bus(constant([0.0; 3]), options);
    let mut sensor = Sensor::new(Address::new(address).unwrap(), Settings::array().check().unwrap());
    let mut delay = bus.clock();
    sensor.start(&mut bus, &mut delay).unwrap();
    bus.clock().advance_ns(10_000_000);
    (0..reads).map(|_| f64::from(next(&mut bus, &mut sensor).unwrap().y.unwrap())).collect()
}

#[test]
fn noise_has_the_given_deviation_and_no_correlation() {
    let counts = counts(1, 0, ADDRESS, 4000);
    let mean = counts.iter().sum::<f64>() / 4000.0;
    let variance = counts.iter().map(|count| (count - mean) * (count - mean)).sum::<f64>() / 4000.0;
    let covariance = counts.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum::<f64>() / 3999.0;
    // 1.5 µT are 10 counts. The bounds are four standard errors.
    assert!(mean.abs() < 0.64, "{mean}");
    assert!((variance.sqrt() - 10.0).abs() < 0.45, "{}", variance.sqrt());
    assert!((covariance / variance).abs() < 0.064, "{covariance}");
}

#[test]
fn the_seed_determines_the_noise_and_sensors_differ() {
    let reference = counts(1, 0, ADDRESS, 20);
    assert_eq!(counts(1, 0, ADDRESS, 20), reference);
    assert_ne!(counts(2, 0, ADDRESS, 20), reference);
    assert_ne!(counts(1, 1, ADDRESS, 20), reference);
    assert_ne!(counts(1, 0, ADDRESS + 1, 20), reference);
}

#[test]
fn the_noise_of_each_start_is_different() {
    let options = SensorOptions { noise_microtesla: [1.5; 3], ..SensorOptions::default() };
    let mut bus = bus(constant([0.0; 3]), options);
    let mut sensor = Sensor::new(Address::new(ADDRESS).unwrap(), Settings::array().check().unwrap());
    let mut session = || {
        let mut delay = bus.clock();
        sensor.start(&mut bus, &mut delay).unwrap();
        bus.clock().advance_ns(10_000_000);
        [(); 20].map(|()| next(&mut bus, &mut sensor).unwrap().y)
    };
    assert_ne!(session(), session());
}
