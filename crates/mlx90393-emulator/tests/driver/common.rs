//! A bus with one sensor, and a driver for it.

use vibrissa_mlx90393::{Address, Measurement, ReadError, Sensor, Settings};
use vibrissa_mlx90393_emulator::{EmulatedBus, EmulatedBusError, EmulatedSensor, FieldSource, SensorOptions};

pub(crate) const ADDRESS: u8 = 0x0C;
/// The control period of 300 Hz (ns).
pub(crate) const PERIOD_NS: u64 = 3_333_333;

pub(crate) type Read = Result<Measurement, ReadError<EmulatedBusError>>;

/// A constant field (µT).
pub(crate) fn constant(field: [f64; 3]) -> impl FieldSource {
    move |_: usize, _: u64| field
}

/// A bus with a sensor, two milliseconds after power-on.
pub(crate) fn bus<F: FieldSource>(field: F, options: SensorOptions) -> EmulatedBus<F> {
    let mut bus = EmulatedBus::new(field);
    bus.add(EmulatedSensor::new(options));
    bus.set_now_ns(2_000_000);
    bus
}

pub(crate) fn driver(settings: Settings) -> Sensor {
    Sensor::new(Address::new(ADDRESS).unwrap(), settings.check().unwrap())
}

/// A bus with a sensor in burst mode, and its driver.
pub(crate) fn started<F: FieldSource>(
    field: F,
    options: SensorOptions,
    settings: Settings,
) -> (EmulatedBus<F>, Sensor) {
    let mut bus = bus(field, options);
    let mut sensor = driver(settings);
    let mut delay = bus.clock();
    sensor.start(&mut bus, &mut delay).unwrap();
    (bus, sensor)
}

/// A sensor of the array in a field of 30 µT along Y, so that reads are fresh at 300 Hz.
pub(crate) fn array() -> (EmulatedBus<impl FieldSource>, Sensor) {
    let (bus, sensor) = started(constant([0.0, 30.0, 0.0]), SensorOptions::default(), Settings::array());
    bus.clock().advance_ns(PERIOD_NS);
    (bus, sensor)
}

/// A read at the next control period.
pub(crate) fn next<F: FieldSource>(bus: &mut EmulatedBus<F>, sensor: &mut Sensor) -> Read {
    bus.clock().advance_ns(PERIOD_NS);
    sensor.read(bus)
}
