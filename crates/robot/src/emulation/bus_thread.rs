//! The acquisition thread of an emulated bus.

use std::cell::RefCell;
use std::rc::Rc;

use embedded_hal::i2c::{ErrorType, I2c, Operation};
use rtrb::Producer;
use vibrissa_mlx90393_emulator::{BusFault, Emulated, EmulatedBus, EmulatedBusError, FieldSource, SensorFault};

use super::plant::Plant;
use super::scheduler::{EmulationError, Settings};
use super::timeline::Timeline;
use crate::array::{Acquisition, Bus, Magnet, Round};
use crate::config::Config;
use crate::sensor::{EmulatedBoard, Sensor, SensorModel};
use crate::vitals::{Phase, Vitals};

/// An acquisition thread.
pub(super) struct BusThread<P> {
    sensor: SensorModel,
    bus: TimedBus<P>,
    acquisition: Acquisition,
    rounds: Producer<Round>,
    whiskers: Vec<usize>,
    addresses: Vec<u8>,
    pub(super) next_slot: u64,
    /// A round that has not ended yet.
    pub(super) pending: Option<Round>,
}

impl<P: Plant> BusThread<P> {
    /// The thread of the bus with this index. Its sensors are started.
    pub(super) fn start(
        config: &Config,
        index: u8,
        sensor: SensorModel,
        timeline: &Rc<RefCell<Timeline<P>>>,
        settings: &Settings,
        rounds: Producer<Round>,
    ) -> Result<Self, EmulationError> {
        let bus = usize::from(index);
        let boards = config.buses.get(bus).map(|bus| bus.boards.as_slice()).unwrap_or_default();
        let mut thread = Self {
            sensor,
            bus: TimedBus(emulated_bus(config, &sensor, bus, timeline, settings)),
            acquisition: Acquisition::new(index, boards, &sensor)?,
            rounds,
            whiskers: config.whiskers_on(bus),
            addresses: boards.iter().map(|board| board.address).collect(),
            next_slot: 0,
            pending: None,
        };
        thread.acquisition.start(&mut thread.bus)?;
        // The first round begins after the bring-up.
        thread.next_slot = thread.bus.now_ns() / crate::array::period_ns(config.rig.sensing.sample_rate) + 1;
        Ok(thread)
    }

    /// Begins the next round at `now_ns`. It is delivered when it ends.
    pub(super) fn acquire(&mut self, now_ns: u64, period_ns: u64, vitals: &Vitals) {
        self.bus.0.clock().advance_to_ns(now_ns);
        let slot = self.next_slot;
        let round = self.acquisition.round(slot, &mut self.bus);
        // A round that takes longer than a period misses the periods that begin meanwhile.
        let next = (round.ended_ns / period_ns + 1).max(slot + 1);
        vitals.miss(Phase::Acquisition, next - slot - 1);
        self.next_slot = next;
        self.pending = Some(round);
    }

    /// Delivers the round that has ended.
    pub(super) fn deliver(&mut self, vitals: &Vitals) {
        if let Some(round) = self.pending.take() {
            vitals.round_ended(&round, &self.whiskers);
            // A full queue means that control hangs, and its own watch reports that.
            let _ = self.rounds.push(round);
        }
    }

    /// Begins or ends a fault of the bus.
    pub(super) fn switch_bus_fault(&mut self, begins: bool, fault: BusFault) {
        if begins { self.bus.0.inject(fault) } else { self.bus.0.clear() }
    }

    /// Begins or ends impossible answers of the sensor of a whisker, if it is on this bus.
    pub(super) fn switch_garbled(&mut self, whisker: u8, begins: bool) {
        self.switch_sensor_fault(whisker, begins, self.sensor.garbled());
    }

    /// Begins or ends a fault of the sensor of a whisker, if it is on this bus.
    pub(super) fn switch_sensor_fault(&mut self, whisker: u8, begins: bool, fault: SensorFault) {
        let board = self.whiskers.iter().position(|&index| index == usize::from(whisker));
        let Some(&address) = board.and_then(|board| self.addresses.get(board)) else { return };
        let bus = &mut self.bus.0;
        let changed = if begins { bus.inject_at(address, fault) } else { bus.clear_at(address) };
        // Every address of the configuration has a sensor.
        debug_assert!(changed.is_ok());
    }
}

/// An emulated bus with its own time.
struct TimedBus<P>(ArrayBus<P>);

/// A bus with boards of any sensor.
type ArrayBus<P> = EmulatedBus<ArrayField<P>, dyn Emulated>;

impl<P> ErrorType for TimedBus<P> {
    type Error = EmulatedBusError;
}

impl<P: Plant> I2c for TimedBus<P> {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Self::Error> {
        self.0.transaction(address, operations)
    }
}

impl<P: Plant> Bus for TimedBus<P> {
    fn now_ns(&self) -> u64 {
        self.0.clock().now_ns()
    }

    fn pause_ns(&mut self, duration_ns: u64) {
        self.0.clock().advance_ns(duration_ns);
    }
}

/// The fields at the sensors of a bus: those of the plant's base moments, along Y.
struct ArrayField<P> {
    timeline: Rc<RefCell<Timeline<P>>>,
    /// The whisker of each sensor, and its magnet.
    magnets: Vec<(usize, Magnet)>,
}

impl<P: Plant> FieldSource for ArrayField<P> {
    fn field_microtesla(&mut self, sensor: usize, time_ns: u64) -> [f64; 3] {
        let Some((whisker, magnet)) = self.magnets.get(sensor) else { return [0.0; 3] };
        let moments = self.timeline.borrow_mut().at(time_ns).base_moments;
        [0.0, magnet.field_microtesla(moments.get(*whisker).copied().unwrap_or(0.0)), 0.0]
    }
}

/// A bus with the boards of the configuration.
fn emulated_bus<P: Plant>(
    config: &Config,
    sensor: &SensorModel,
    bus: usize,
    timeline: &Rc<RefCell<Timeline<P>>>,
    settings: &Settings,
) -> ArrayBus<P> {
    let boards: Vec<_> = config.boards().filter(|board| board.0 == bus).collect();
    let magnets = boards.iter().filter_map(|&(bus, board, whisker)| {
        let board = config.buses.get(bus)?.boards.get(board)?;
        Some((whisker, Magnet { field_per_moment: board.field_per_moment, cubic: board.cubic }))
    });
    let magnets = magnets.collect();
    let mut emulated = EmulatedBus::new(ArrayField { timeline: Rc::clone(timeline), magnets });
    for (field_index, &(bus, board, whisker)) in boards.iter().enumerate() {
        let Some(board) = config.buses.get(bus).and_then(|bus| bus.boards.get(board)) else { continue };
        let deviation = f64::from(u32::try_from((settings.seed * 7 + whisker as u64 * 3) % 9).unwrap_or(0)) / 4.0 - 1.0;
        emulated.add(sensor.emulated(&EmulatedBoard {
            address: board.address,
            field_index,
            deviation,
            noise_microtesla: settings.noise_microtesla,
            seed: settings.seed.wrapping_mul(31).wrapping_add(whisker as u64),
        }));
    }
    emulated
}
