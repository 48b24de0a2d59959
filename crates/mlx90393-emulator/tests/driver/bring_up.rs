//! The start of a sensor.

use crate::common::{ADDRESS, PERIOD_NS, bus, constant, driver, next, started};
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use proptest::prelude::*;
use vibrissa_mlx90393::{Address, CommandError, ReadError, Register, Sensor, Settings, StartError, Step};
use vibrissa_mlx90393_emulator::{EmulatedBus, EmulatedBusError, EmulatedSensor, SensorOptions};

#[test]
fn a_started_sensor_is_stale_until_its_first_conversion_and_then_gives_the_field() {
    let (mut bus, mut sensor) = started(constant([0.0, 30.0, 0.0]), SensorOptions::default(), Settings::array());
    assert!(matches!(sensor.read(&mut bus), Err(ReadError::Stale { .. })));
    bus.clock().advance_ns(PERIOD_NS);
    assert_eq!(next(&mut bus, &mut sensor).unwrap().y, Some(200));
}

#[test]
fn a_start_works_from_any_mode() {
    for command in [0x00, 0x80, 0x14, 0x3F, 0xD0, 0xF0] {
        let mut bus = bus(constant([0.0; 3]), SensorOptions::default());
        bus.write(ADDRESS, &[command]).unwrap();
        bus.clock().advance_ns(1_600_000);
        let mut delay = bus.clock();
        driver(Settings::array()).start(&mut bus, &mut delay).unwrap();
    }
}

#[test]
fn a_delay_shorter_than_the_reset_is_an_error() {
    let mut bus = bus(constant([0.0; 3]), SensorOptions::default());
    let result = driver(Settings::array()).start(&mut bus, &mut NoDelay);
    let error = EmulatedBusError::NoAcknowledge { address: ADDRESS };
    let step = Step::ReadRegister(Register::GAIN);
    assert_eq!(result, Err(StartError::Command(CommandError::Bus { step, error })));
}

/// A delay that takes no time.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

#[test]
fn an_absent_sensor_is_not_started() {
    let mut bus = bus(constant([0.0; 3]), SensorOptions { address: 0x0D, ..SensorOptions::default() });
    let mut delay = bus.clock();
    let error = EmulatedBusError::NoAcknowledge { address: ADDRESS };
    assert_eq!(
        driver(Settings::array()).start(&mut bus, &mut delay),
        Err(StartError::Command(CommandError::Bus { step: Step::Exit, error }))
    );
}

#[test]
fn registers_can_be_read_again_after_a_stop() {
    let (mut bus, mut sensor) = started(constant([0.0; 3]), SensorOptions::default(), Settings::array());
    assert!(matches!(sensor.read_register(&mut bus, Register::GAIN), Err(CommandError::Rejected { .. })));
    sensor.stop(&mut bus).unwrap();
    assert_eq!(sensor.read_register(&mut bus, Register::CONVERSION).unwrap().1, 0x000E);
    assert!(matches!(sensor.read(&mut bus), Err(ReadError::ModeLost { .. })));
}

#[test]
fn three_sensors_on_one_bus_give_their_own_fields() {
    let mut bus = EmulatedBus::new(|sensor: usize, _: u64| [0.0, 30.0 * sensor as f64, 0.0]);
    let addresses = [0x0C, 0x0D, 0x0E];
    for (field_index, address) in addresses.into_iter().enumerate() {
        bus.add(EmulatedSensor::new(SensorOptions { address, field_index, ..SensorOptions::default() }));
    }
    let mut sensors =
        addresses.map(|address| Sensor::new(Address::new(address).unwrap(), Settings::array().check().unwrap()));
    let mut delay = bus.clock();
    for sensor in &mut sensors {
        sensor.start(&mut bus, &mut delay).unwrap();
    }
    bus.clock().advance_ns(2 * PERIOD_NS);
    let counts = sensors.each_mut().map(|sensor| sensor.read(&mut bus).unwrap().y);
    assert_eq!(counts, [Some(0), Some(200), Some(400)]);
}

proptest! {
    #[test]
    fn a_start_keeps_every_factory_trim(factory_trim in 0_u8..128) {
        let options = SensorOptions { factory_trim, ..SensorOptions::default() };
        let mut bus = bus(constant([0.0; 3]), options);
        let mut delay = bus.clock();
        let report = driver(Settings::array()).start(&mut bus, &mut delay).unwrap();
        prop_assert_eq!(report.factory_trim, factory_trim);
        prop_assert!(bus.sensor(ADDRESS).unwrap().factory_trim_is_intact());
        let registers = [0, 1, 2].map(|address| bus.sensor(ADDRESS).unwrap().register(address).unwrap());
        prop_assert_eq!(report.registers, registers);
    }
}
