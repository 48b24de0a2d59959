//! The sensor's oscillator, and the clock of the bus.

use crate::common::{ADDRESS, PERIOD_NS, bus, constant, started};
use embedded_hal::i2c::I2c;
use proptest::prelude::*;
use std::num::NonZeroU32;
use vibrissa_mlx90393::{Address, Axes, ReadError, Settings, measure_bus_clock, round_time};
use vibrissa_mlx90393_emulator::SensorOptions;

#[test]
fn a_transaction_takes_the_clocks_of_the_bus_protocol() {
    for (command, bytes, clocks) in [(0x44, 3, 57), (0x4E, 7, 93), (0x4F, 9, 111)] {
        for frequency_hz in [100_000_u32, 400_000] {
            let mut bus = bus(constant([0.0; 3]), SensorOptions::default());
            bus.set_frequency_hz(NonZeroU32::new(frequency_hz).unwrap());
            let start_ns = bus.now_ns();
            bus.write_read(ADDRESS, &[command], &mut vec![0; bytes]).unwrap();
            assert_eq!(bus.now_ns() - start_ns, clocks * 1_000_000_000 / u64::from(frequency_hz));
        }
    }
}

#[test]
fn three_sensors_at_400_khz_take_as_long_as_the_driver_predicts() {
    let mut bus = bus(constant([0.0; 3]), SensorOptions::default());
    let now = bus.clock();
    let clock = measure_bus_clock(&mut bus, Address::new(ADDRESS).unwrap(), || now.now_ns()).unwrap();
    assert_eq!((clock.frequency_hz, clock.overhead_ns), (400_000, 0));
    assert_eq!((round_time(3, Axes::Y, clock), round_time(3, Axes::XYZ, clock)), (428, 698));
}

#[test]
fn the_driver_finds_a_slow_clock_and_the_overhead() {
    let mut bus = bus(constant([0.0; 3]), SensorOptions::default());
    bus.set_frequency_hz(NonZeroU32::new(100_000).unwrap());
    bus.set_overhead_ns(50_000);
    let now = bus.clock();
    let clock = measure_bus_clock(&mut bus, Address::new(ADDRESS).unwrap(), || now.now_ns()).unwrap();
    assert_eq!((clock.frequency_hz, clock.overhead_ns), (100_000, 50_000));
}

/// Number of fresh reads of 1000 at 300 Hz. The read at an index ends its command `read_clocks` after its start.
fn fresh_reads(clock_ratio: f64, settings: Settings) -> (u32, u32) {
    let options = SensorOptions { clock_ratio, ..SensorOptions::default() };
    let (mut bus, mut sensor) = started(constant([0.0; 3]), options, settings);
    // The command to start ended before its status: one restart, two bytes, one stop.
    let command_ns = bus.now_ns() as f64 - 20.0 * 2500.0;
    let period_ns = 1e3 * f64::from(sensor.settings().burst_period().nominal_us) / clock_ratio;
    let first_ns = command_ns + 1e3 * (220.0 + 360.0) / clock_ratio + period_ns;
    let start_ns = bus.now_ns() + 100_000_000;
    let (mut fresh, mut predicted, mut last) = (0, 0, -1.0);
    for tick in 0..1000 {
        let tick_ns = start_ns + tick * PERIOD_NS;
        bus.set_now_ns(tick_ns);
        match sensor.read(&mut bus) {
            Ok(_) => fresh += 1,
            Err(error) => assert!(matches!(error, ReadError::Stale { .. })),
        }
        // The command of a read ends 19 clocks after its start.
        let set = ((tick_ns as f64 + 19.0 * 2500.0 - first_ns) / period_ns).floor();
        predicted += u32::from(set > last);
        last = set;
    }
    (fresh, predicted)
}

proptest! {
    #[test]
    fn reads_are_fresh_as_the_oscillator_predicts(clock_ratio in 0.9..1.1, y_only in any::<bool>()) {
        // The second setting converts three axes too slowly for 300 Hz.
        let settings = if y_only { Settings::array() } else { Settings { axes: Axes::XYZ, ..Settings::array() } };
        let (fresh, predicted) = fresh_reads(clock_ratio, settings);
        // A conversion that ends within a nanosecond of a read may count either way.
        prop_assert!(fresh.abs_diff(predicted) <= 1, "{fresh}, {predicted}");
    }

    #[test]
    fn a_checked_rate_has_only_fresh_reads(clock_ratio in 0.9..1.1) {
        for settings in [Settings::array(), Settings::array_xyz()] {
            settings.check().unwrap().check_rate(300.0).unwrap();
            prop_assert_eq!(fresh_reads(clock_ratio, settings).0, 1000);
        }
    }
}

#[test]
fn a_slow_sensor_gives_stale_reads_in_proportion() {
    let settings = Settings { axes: Axes::XYZ, ..Settings::array() };
    // Three axes take 7.981 ms, so a tenth slower there are 37.6 sets in 100 periods.
    let (fresh, _) = fresh_reads(0.9, settings);
    assert_eq!(fresh, 376);
}

#[test]
fn no_read_depends_on_how_many_were_made_before() {
    let ramp = |_: usize, time_ns: u64| [0.0, time_ns as f64 * 1e-6, 0.0];
    let options = SensorOptions { noise_microtesla: [1.0; 3], seed: 3, ..SensorOptions::default() };
    let (mut often, mut sensor) = started(ramp, options.clone(), Settings::array());
    let (mut once, _) = started(ramp, options, Settings::array());
    let start_ns = often.now_ns();
    let mut last = None;
    for tick in 1..=300 {
        often.set_now_ns(start_ns + tick * PERIOD_NS);
        once.set_now_ns(start_ns + tick * PERIOD_NS);
        last = sensor.read(&mut often).ok();
    }
    assert_eq!(sensor.read(&mut once).unwrap(), last.unwrap());
}
