//! An emulated bus.

use crate::bus_error::EmulatedBusError;
use crate::clock::EmulatedClock;
use crate::emulated::Emulated;
use crate::fault::{BusFault, SensorFault};
use crate::field::FieldSource;
use crate::sensor::EmulatedSensor;
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use std::num::NonZeroU32;

/// The bus clock of fast mode, which is the sensor's highest (Hz).
const FAST_MODE_HZ: NonZeroU32 = NonZeroU32::MIN.saturating_add(399_999);

/// An I²C bus with emulated sensors.
///
/// A transaction takes 9 clocks per byte, addresses included, and one clock per start, repeated start and stop. A command is
/// executed when its last byte ends.
#[derive(Debug)]
pub struct EmulatedBus<F, S: ?Sized = EmulatedSensor> {
    field: F,
    clock: EmulatedClock,
    sensors: Vec<Box<S>>,
    frequency_hz: NonZeroU32,
    overhead_ns: u64,
    fault: Option<BusFault>,
}

impl<F: FieldSource, S: Emulated + ?Sized> EmulatedBus<F, S> {
    /// Creates a bus without sensors at 400 kHz, with its own clock at time 0.
    #[must_use]
    pub fn new(field: F) -> Self {
        Self::with_clock(field, EmulatedClock::new())
    }

    /// Creates a bus without sensors at 400 kHz that uses a clock, for instance that of another bus.
    ///
    /// Buses with the same clock are read one after the other. Buses with different clocks are read at the same time.
    #[must_use]
    pub fn with_clock(field: F, clock: EmulatedClock) -> Self {
        let (sensors, overhead_ns) = (Vec::new(), 0);
        Self { field, clock, sensors, frequency_hz: FAST_MODE_HZ, overhead_ns, fault: None }
    }

    /// Adds a sensor. Of sensors with the same address, only the first answers.
    pub fn add(&mut self, sensor: impl Into<Box<S>>) {
        self.sensors.push(sensor.into());
    }

    /// The sensor with an address.
    #[must_use]
    pub fn sensor(&self, address: u8) -> Option<&S> {
        self.sensors.iter().map(Box::as_ref).find(|sensor| sensor.address() == address)
    }

    /// The clock. It is shared, so it stays usable while the bus is borrowed.
    #[must_use]
    pub fn clock(&self) -> EmulatedClock {
        self.clock.clone()
    }

    /// The time (ns).
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        self.clock.now_ns()
    }

    /// Advances the time to a value (ns). The time never goes back.
    pub fn set_now_ns(&mut self, now_ns: u64) {
        self.clock.advance_to_ns(now_ns);
    }

    /// Sets the frequency of the bus clock (Hz).
    pub fn set_frequency_hz(&mut self, frequency_hz: NonZeroU32) {
        self.frequency_hz = frequency_hz;
    }

    /// Sets the time that passes before each transaction (ns), for instance in the operating system.
    pub fn set_overhead_ns(&mut self, overhead_ns: u64) {
        self.overhead_ns = overhead_ns;
    }

    /// Sets the fault of the bus. An earlier one ends.
    pub fn inject(&mut self, fault: BusFault) {
        self.fault = Some(fault);
    }

    /// Adds a fault to a sensor.
    ///
    /// # Errors
    /// [`EmulatedBusError::NoAcknowledge`] if there is no sensor with this address.
    pub fn inject_at(&mut self, address: u8, fault: SensorFault) -> Result<(), EmulatedBusError> {
        let now_ns = self.now_ns();
        self.find(address)?.inject(fault, now_ns);
        Ok(())
    }

    /// Ends all faults of the bus and of its sensors.
    pub fn clear(&mut self) {
        self.fault = None;
        let now_ns = self.now_ns();
        for sensor in &mut self.sensors {
            sensor.clear(now_ns);
        }
    }

    /// Ends the faults of one sensor.
    ///
    /// # Errors
    /// [`EmulatedBusError::NoAcknowledge`] if there is no sensor with this address.
    pub fn clear_at(&mut self, address: u8) -> Result<(), EmulatedBusError> {
        let now_ns = self.now_ns();
        self.find(address)?.clear(now_ns);
        Ok(())
    }

    fn find(&mut self, address: u8) -> Result<&mut S, EmulatedBusError> {
        self.sensors
            .iter_mut()
            .map(Box::as_mut)
            .find(|sensor| sensor.address() == address)
            .ok_or(EmulatedBusError::NoAcknowledge { address })
    }

    /// Performs a transaction from a time on. The result is the time that it takes (ns), also for an error.
    fn perform(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
        start_ns: u64,
    ) -> (u64, Result<(), EmulatedBusError>) {
        let frequency_hz = u64::from(self.frequency_hz.get());
        let clocks_ns = |clocks: u64| clocks * 1_000_000_000 / frequency_hz;
        if let Some(fault) = &mut self.fault {
            match fault.next() {
                // The arbitration is lost at the address, 10 clocks after the start.
                Some(error) => {
                    let EmulatedBusError::Timeout { timeout_ns } = error else { return (clocks_ns(10), Err(error)) };
                    return (timeout_ns, Err(error));
                }
                None => self.fault = None,
            }
        }
        let sensor = self.sensors.iter_mut().map(Box::as_mut).find(|sensor| sensor.address() == address);
        let Some(sensor) = sensor.and_then(|sensor| sensor.acknowledges(start_ns).then_some(sensor)) else {
            // Start, address and stop.
            return (clocks_ns(11), Err(EmulatedBusError::NoAcknowledge { address }));
        };

        let mut clocks = 0;
        let mut phase = Phase::None;
        for operation in operations {
            match operation {
                Operation::Write(bytes) => {
                    if !matches!(phase, Phase::Write(_)) {
                        phase.end(sensor, start_ns + clocks_ns(clocks), &mut self.field);
                        phase = Phase::Write(Command::default());
                        clocks += 10;
                    }
                    if let Phase::Write(command) = &mut phase {
                        command.extend(bytes);
                    }
                    clocks += 9 * bytes.len() as u64;
                }
                Operation::Read(buffer) => {
                    if !matches!(phase, Phase::Read(_)) {
                        phase.end(sensor, start_ns + clocks_ns(clocks), &mut self.field);
                        phase = Phase::Read(0);
                        clocks += 10;
                    }
                    if let Phase::Read(index) = &mut phase {
                        for byte in buffer.iter_mut() {
                            *byte = sensor.read(*index);
                            *index += 1;
                        }
                    }
                    clocks += 9 * buffer.len() as u64;
                }
            }
        }
        phase.end(sensor, start_ns + clocks_ns(clocks), &mut self.field);
        (clocks_ns(clocks + 1), Ok(()))
    }
}

/// The direction of a part of a transaction.
enum Phase {
    /// Before the first operation.
    None,
    /// The sensor receives a command.
    Write(Command),
    /// The sensor sends its answer. The number of sent bytes.
    Read(usize),
}

impl Phase {
    /// Ends the phase at a time (ns).
    fn end(&self, sensor: &mut (impl Emulated + ?Sized), now_ns: u64, field: &mut dyn FieldSource) {
        match self {
            Self::None | Self::Read(0) => {}
            Self::Write(command) => sensor.write(command.bytes(), now_ns, field),
            Self::Read(_) => sensor.end_read(now_ns),
        }
    }
}

/// The bytes of a command. No command has more than four, so further bytes only make it invalid.
#[derive(Default)]
struct Command {
    bytes: [u8; 5],
    length: usize,
}

impl Command {
    fn extend(&mut self, bytes: &[u8]) {
        for (to, from) in self.bytes[self.length..].iter_mut().zip(bytes) {
            *to = *from;
            self.length += 1;
        }
    }

    fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

impl<F, S: ?Sized> ErrorType for EmulatedBus<F, S> {
    type Error = EmulatedBusError;
}

impl<F: FieldSource, S: Emulated + ?Sized> I2c for EmulatedBus<F, S> {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), EmulatedBusError> {
        let time_ns = self.now_ns();
        let (duration_ns, result) = self.perform(address, operations, time_ns + self.overhead_ns);
        self.clock.advance_ns(self.overhead_ns + duration_ns);
        result
    }
}
