//! Fields and temperatures through all settings.

use crate::common::{constant, started};
use proptest::prelude::*;
use vibrissa_mlx90393::{
    Axes, Axis, BurstInterval, DigitalFilter, Gain, Hall, Oversampling, Resolution, Resolutions, Settings, TriggerPin,
};
use vibrissa_mlx90393_emulator::SensorOptions;

fn resolution() -> impl Strategy<Value = Resolution> {
    prop::sample::select(&[Resolution::R0, Resolution::R1, Resolution::R2, Resolution::R3])
}

/// All settings that the driver accepts.
fn settings() -> impl Strategy<Value = Settings> {
    let codes = (0_u8..8, 0_u8..4, 0_u8..4, 0_u8..8, 1_u8..16, 0_u8..64);
    let choices = (prop::bool::ANY, prop::bool::ANY, prop::bool::ANY, prop::bool::ANY);
    (codes, [resolution(), resolution(), resolution()], choices)
        .prop_map(
            |((gain, osr, osr2, filter, axes, interval), [x, y, z], (two_phase, compensated, output, trigger))| {
                Settings {
                    gain: Gain::new(gain).unwrap(),
                    resolution: Resolutions { x, y, z },
                    oversampling: Oversampling::new(osr).unwrap(),
                    temperature_oversampling: Oversampling::new(osr2).unwrap(),
                    filter: DigitalFilter::new(filter).unwrap(),
                    hall: if two_phase { Hall::TwoPhase } else { Hall::FourPhase },
                    axes: Axes::from_nibble(axes),
                    burst_interval: BurstInterval::new(interval).unwrap(),
                    temperature_compensation: compensated,
                    trigger_pin: if output { TriggerPin::DataReady } else { TriggerPin::Input },
                    external_trigger: trigger,
                }
            },
        )
        .prop_filter("the data sheet forbids it", |settings| settings.check().is_ok())
}

/// Highest field of an axis without saturation (µT).
fn range(settings: &Settings, axis: Axis) -> f64 {
    let counts = match settings.resolution.of(axis) {
        Resolution::R0 | Resolution::R1 => 32_766.0,
        Resolution::R2 => 21_999.0,
        Resolution::R3 => 10_999.0,
    };
    counts * f64::from(settings.check().unwrap().field_per_count_microtesla(axis))
}

proptest! {
    #[test]
    fn a_field_comes_back_within_half_a_count(settings in settings(), parts in [-1.0..1.0, -1.0..1.0, -1.0..1.0]) {
        let field: [f64; 3] = std::array::from_fn(|axis| parts[axis] * range(&settings, Axis::ALL[axis]));
        let (mut bus, mut sensor) = started(constant(field), SensorOptions::default(), settings);
        bus.clock().advance_ns(3_000_000_000);
        let measurement = sensor.read(&mut bus).unwrap();
        for (axis, field) in Axis::ALL.into_iter().zip(field) {
            let measured = measurement.field_microtesla(axis);
            prop_assert_eq!(measured.is_some(), settings.axes.has(axis));
            if let Some(measured) = measured {
                let count = f64::from(sensor.settings().field_per_count_microtesla(axis));
                // The rest is the rounding of f32.
                prop_assert!((f64::from(measured) - field).abs() <= 0.5 * count + 1e-6 * field.abs(), "{axis:?}: {measured}, {field}");
                prop_assert!(!measurement.is_saturated(axis));
            }
        }
        prop_assert_eq!(measurement.temperature.is_some(), settings.axes.t);
    }

    #[test]
    fn a_field_that_grows_beyond_the_range_is_saturated_until_it_returns(
        settings in settings(), factor in 1.01_f64..3.0, negative in any::<bool>(),
    ) {
        // Every conversion ends within 3 s, and the field stands still for 10 s at each of these multiples of the range.
        const HOLD_NS: u64 = 10_000_000_000;
        let up: Vec<f64> = (0..8).map(|step| 0.4 * f64::from(step)).take_while(|part| *part < factor).collect();
        let parts: Vec<f64> = up.iter().copied().chain([factor]).chain(up.iter().rev().copied()).collect();
        let sign = if negative { -1.0 } else { 1.0 };
        let unit = Axis::ALL.map(|axis| sign * range(&settings, axis));
        let held = parts.clone();
        let field = move |_: usize, time_ns: u64| {
            let index = usize::try_from(time_ns / HOLD_NS).unwrap().min(held.len() - 1);
            unit.map(|unit| unit * held[index])
        };
        let (mut bus, mut sensor) = started(field, SensorOptions::default(), settings);
        for (index, part) in (0_u64..).zip(parts) {
            bus.set_now_ns(index * HOLD_NS + 9_000_000_000);
            let measurement = sensor.read(&mut bus).unwrap();
            for axis in Axis::ALL {
                let expected = part > 1.0 && settings.axes.has(axis);
                prop_assert_eq!(measurement.is_saturated(axis), expected, "{:?} at {} of the range", axis, part);
            }
        }
    }

    /// Without an earlier measurement, a wrapped field is no different from one of the other sign. The coarse resolutions do
    /// not wrap.
    #[test]
    fn with_a_coarse_resolution_a_field_beyond_the_range_is_saturated_at_once(
        settings in settings(), factor in 1.01_f64..3.0, negative in any::<bool>(),
    ) {
        let factor = if negative { -factor } else { factor };
        let field = Axis::ALL.map(|axis| factor * range(&settings, axis));
        let (mut bus, mut sensor) = started(constant(field), SensorOptions::default(), settings);
        bus.clock().advance_ns(3_000_000_000);
        let measurement = sensor.read(&mut bus).unwrap();
        for axis in Axis::ALL {
            if matches!(settings.resolution.of(axis), Resolution::R2 | Resolution::R3) {
                prop_assert_eq!(measurement.is_saturated(axis), settings.axes.has(axis));
            }
        }
    }

    #[test]
    fn a_temperature_comes_back_within_half_a_code(temperature_celsius in -40.0..85.0) {
        let options = SensorOptions { temperature_celsius, ..SensorOptions::default() };
        let settings = Settings { axes: Axes::TXYZ, ..Settings::array() };
        let (mut bus, mut sensor) = started(constant([0.0; 3]), options, settings);
        bus.clock().advance_ns(100_000_000);
        let measured = f64::from(sensor.read(&mut bus).unwrap().temperature_celsius().unwrap());
        prop_assert!((measured - temperature_celsius).abs() < 0.5 / 45.2 + 1e-4);
    }
}

#[test]
fn offset_and_drift_are_added_to_the_field() {
    let options = SensorOptions {
        offset_microtesla: [0.0, 15.0, 0.0],
        offset_drift_microtesla_per_second: [0.0, 1.5, 0.0],
        ..SensorOptions::default()
    };
    let (mut bus, mut sensor) = started(constant([0.0, 30.0, 0.0]), options, Settings::array());
    for seconds in [10, 20] {
        bus.set_now_ns(seconds * 1_000_000_000);
        let counts = sensor.read(&mut bus).unwrap().y.unwrap();
        assert_eq!(counts, 300 + 10 * i32::try_from(seconds).unwrap());
    }
}

#[test]
fn a_measurement_is_the_mean_of_the_field_over_its_conversion() {
    // A field that grows by 1 µT per millisecond, so its mean is that of the middle.
    let ramp = |_: usize, time_ns: u64| [0.0, time_ns as f64 * 1e-6, 0.0];
    let (mut bus, mut sensor) = started(ramp, SensorOptions::default(), Settings::array());
    let start_ns = bus.now_ns() as f64;
    bus.clock().advance_ns(5_000_000);
    let field = f64::from(sensor.read(&mut bus).unwrap().field_microtesla(Axis::Y).unwrap());
    // The command ended 20 clocks before the end of its transaction.
    let middle_ns = start_ns - 20.0 * 2500.0 + 1000.0 * (220.0 + 360.0 + 0.5 * 2627.0);
    assert!((field - middle_ns * 1e-6).abs() < 0.15, "{field}, {middle_ns}");
}
