//! The MLX90393, of which the array reads the Y axis.

use std::cell::RefCell;

use serde::{Deserialize, Serialize};
use vibrissa_mlx90393::{
    Address, Axes, Axis, CheckedSettings, DigitalFilter, Gain, Measurement, Oversampling, ReadError, Resolution,
    Resolutions, Settings, decode, measure_bus_clock, round_time,
};
#[cfg(feature = "emulation")]
use vibrissa_mlx90393_emulator::{Emulated, EmulatedSensor, SensorFault, SensorOptions};

#[cfg(feature = "emulation")]
use super::EmulatedBoard;
use super::{BusClock, RawRead, Refused, Section, Sensor, SensorDriver};
use crate::array::{BoardReading, Bus, Port, ReadingState};
use crate::config::whole_number;

/// Bits of a status byte that give a sensor in burst mode two other modes, which is impossible.
#[cfg(feature = "emulation")]
const TWO_MODES: u8 = 0x60;

/// The settings of the sensors. They are those of the baseline's array by default.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// Oversampling ratio, OSR (0 to 3).
    #[serde(deserialize_with = "whole_number::up_to::<3, _>")]
    pub oversampling: u8,
    /// Digital filter, `DIG_FILT` (0 to 7).
    #[serde(deserialize_with = "whole_number::up_to::<7, _>")]
    pub filter: u8,
    /// Gain, `GAIN_SEL` (0 to 7). 7 is the most sensitive.
    #[serde(deserialize_with = "whole_number::up_to::<7, _>")]
    pub gain: u8,
    /// Resolution of the Y axis, `RES_Y` (0 to 3). 0 is the finest.
    #[serde(deserialize_with = "whole_number::up_to::<3, _>")]
    pub resolution: u8,
}

impl Default for Config {
    fn default() -> Self {
        Self { oversampling: 2, filter: 3, gain: 7, resolution: 0 }
    }
}

/// The settings with the Y axis in continuous burst mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model(CheckedSettings);

/// The driver of a board.
#[derive(Debug)]
pub struct Driver(vibrissa_mlx90393::Sensor);

impl Section for Config {
    type Model = Model;

    fn first_address(&self) -> u8 {
        0x0C
    }

    fn model(&self, sample_rate: f64) -> Result<Model, Refused> {
        let resolution = [Resolution::R0, Resolution::R1, Resolution::R2, Resolution::R3];
        let resolution = resolution.get(usize::from(self.resolution)).copied().unwrap_or(Resolution::R3);
        let settings = Settings {
            gain: Gain::new(self.gain).map_err(Refused::by)?,
            resolution: Resolutions::all(resolution),
            oversampling: Oversampling::new(self.oversampling).map_err(Refused::by)?,
            filter: DigitalFilter::new(self.filter).map_err(Refused::by)?,
            ..Settings::array()
        };
        let checked = settings.check().map_err(Refused::by)?;
        #[expect(clippy::cast_possible_truncation, reason = "a rate of some hundred hertz")]
        checked.check_rate(sample_rate as f32).map_err(Refused::by)?;
        Ok(Model(checked))
    }
}

impl Sensor for Model {
    type Driver = Driver;

    fn microtesla_per_count(&self) -> f64 {
        f64::from(self.0.field_per_count_microtesla(Axis::Y))
    }

    /// 45 µT at the finest resolution. It is five times the range of the sensor's own noise.
    fn largest_rest_spread(&self) -> u32 {
        300
    }

    fn conversion_us(&self) -> u32 {
        self.0.conversion_time().nominal_us
    }

    fn round_us(&self, boards: u32, clock: BusClock) -> u32 {
        round_time(boards, Axes::Y, clock)
    }

    fn decode(&self, received: &[u8]) -> ReadingState {
        state(&decode(&self.0, received))
    }

    fn bus_clock<B: Bus>(&self, bus: &mut B, address: u8, now_ns: impl FnMut() -> u64) -> Result<BusClock, Refused> {
        measure_bus_clock(bus, Address::new(address).map_err(Refused::by)?, now_ns).map_err(Refused::by)
    }

    fn driver(&self, address: u8) -> Result<Driver, Refused> {
        let address = Address::new(address).map_err(Refused::by)?;
        Ok(Driver(vibrissa_mlx90393::Sensor::new(address, self.0)))
    }

    /// Oscillators differ by up to 10 %, and offsets by hundreds of counts.
    #[cfg(feature = "emulation")]
    fn emulated(&self, board: &EmulatedBoard) -> Box<dyn Emulated> {
        let &EmulatedBoard { address, field_index, deviation, noise_microtesla, seed } = board;
        Box::new(EmulatedSensor::new(SensorOptions {
            address,
            field_index,
            clock_ratio: 1.0 + 0.1 * deviation,
            noise_microtesla: [noise_microtesla; 3],
            offset_microtesla: [0.0, 60.0 * deviation, 0.0],
            seed,
            ..SensorOptions::default()
        }))
    }

    #[cfg(feature = "emulation")]
    fn garbled(&self) -> SensorFault {
        SensorFault::BitFlip { byte: 0, mask: TWO_MODES, answers: u32::MAX }
    }
}

impl SensorDriver for Driver {
    fn start<B: Bus>(&mut self, bus: &mut B) -> Result<(), Refused> {
        let shared = RefCell::new(bus);
        self.0.start(&mut Port(&shared), &mut Port(&shared)).map(drop).map_err(Refused::by)
    }

    fn read<B: Bus>(&mut self, bus: &mut B) -> BoardReading {
        let read = self.0.read(bus);
        let raw = match &read {
            Ok(measurement) => Some(measurement.raw),
            Err(error) => error.raw().copied(),
        };
        BoardReading { state: state(&read), raw: raw.unwrap_or(RawRead::from_bytes(&[])) }
    }
}

/// The result of a read of the driver. It depends only on the received bytes, if there are any, except for a wrapped
/// field, which the driver notices by the readings before.
fn state<E>(read: &Result<Measurement, ReadError<E>>) -> ReadingState {
    match read {
        Ok(measurement) => match measurement.y {
            Some(_) if measurement.is_saturated(Axis::Y) => ReadingState::Saturated,
            Some(counts) => ReadingState::Fresh(counts),
            None => ReadingState::Garbled,
        },
        Err(ReadError::Stale { .. }) => ReadingState::Stale,
        Err(ReadError::Garbled { .. }) => ReadingState::Garbled,
        Err(ReadError::ModeLost { .. } | ReadError::Reset { .. }) => ReadingState::Lost,
        Err(ReadError::Bus(_)) => ReadingState::Silent,
    }
}
