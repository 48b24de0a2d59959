//! Acquisition: the thread of one bus, which reads every board once per sample period.

use std::cell::RefCell;

use vibrissa_mlx90393::{
    Address, CheckedSettings, InvalidAddress, Measurement, RawRead, ReadError, Sensor, StartError,
};

use super::bus::{Bus, Port};
use super::round::{BoardReading, ReadingState, Round};
use crate::config::{BoardConfig, MAX_BOARDS};

/// Time (ns) until the bring-up of a lost board is tried again. A bring-up takes about 4 ms of the bus.
const RETRY_NS: u64 = 100_000_000;
/// Consecutive failures of a board until its bring-up is tried again: 50 ms, so that the supervisor sees their kind before.
const MOST_FAILURES: u32 = 15;
/// Consecutive rounds without a new value until the bring-up is tried again.
const MOST_STALE: u32 = 30;
/// Duration (ns) of a call after which the rest of a round is left out. The Raspberry Pi 5 blocks a caller for 1.024 s
/// while a device holds the bus, and would do so again for every further board.
const BLOCKED_NS: u64 = 20_000_000;

/// The acquisition of one bus.
#[derive(Debug)]
pub struct Acquisition {
    bus: u8,
    boards: Vec<Board>,
}

#[derive(Debug)]
struct Board {
    sensor: Sensor,
    is_started: bool,
    failures: u32,
    stale: u32,
    /// Earliest time of the next bring-up (ns).
    retry_ns: u64,
}

/// A board that cannot be brought up.
#[derive(Debug, thiserror::Error)]
#[error("the sensor with address {address:#04x} cannot be started: {message}")]
pub struct StartFault {
    address: u8,
    message: String,
}

impl Acquisition {
    /// The acquisition of these boards on the bus with this index.
    ///
    /// # Errors
    /// [`InvalidAddress`] if a board has an address that the sensor cannot have.
    pub fn new(bus: u8, boards: &[BoardConfig], settings: CheckedSettings) -> Result<Self, InvalidAddress> {
        let board = |address| {
            let sensor = Sensor::new(Address::new(address)?, settings);
            Ok(Board { sensor, is_started: false, failures: 0, stale: 0, retry_ns: 0 })
        };
        let boards = boards.iter().take(MAX_BOARDS).map(|config| board(config.address));
        Ok(Self { bus, boards: boards.collect::<Result<_, _>>()? })
    }

    /// Brings up every board. Later, lost boards are brought up again by [`round`](Self::round).
    ///
    /// # Errors
    /// [`StartFault`] with the first board that fails.
    pub fn start<B: Bus>(&mut self, bus: &mut B) -> Result<(), StartFault> {
        for board in &mut self.boards {
            let address = board.sensor.address().get();
            board.start(bus).map_err(|error| StartFault { address, message: error.to_string() })?;
        }
        Ok(())
    }

    /// Reads every board once. It waits for nothing, except that it brings up a lost board again.
    pub fn round<B: Bus>(&mut self, slot: u64, bus: &mut B) -> Round {
        let silent = BoardReading { state: ReadingState::Silent, raw: RawRead::from_bytes(&[]) };
        let started_ns = bus.now_ns();
        let mut readings = [silent; MAX_BOARDS];
        for (board, reading) in self.boards.iter_mut().zip(&mut readings) {
            let before_ns = bus.now_ns();
            *reading = board.read(bus);
            if bus.now_ns() - before_ns > BLOCKED_NS {
                break;
            }
        }
        let count = u8::try_from(self.boards.len()).unwrap_or(u8::MAX);
        Round { bus: self.bus, slot, started_ns, ended_ns: bus.now_ns(), count, readings }
    }
}

impl Board {
    fn start<B: Bus>(&mut self, bus: &mut B) -> Result<(), StartError<B::Error>> {
        let shared = RefCell::new(bus);
        self.sensor.start(&mut Port(&shared), &mut Port(&shared))?;
        (self.is_started, self.failures, self.stale) = (true, 0, 0);
        Ok(())
    }

    fn read<B: Bus>(&mut self, bus: &mut B) -> BoardReading {
        if !self.is_started {
            let now_ns = bus.now_ns();
            if now_ns >= self.retry_ns && self.start(bus).is_err() {
                self.retry_ns = bus.now_ns() + RETRY_NS;
            }
            // The first value after a bring-up comes with the next round.
            return BoardReading { state: ReadingState::Lost, raw: RawRead::from_bytes(&[]) };
        }
        let result = self.sensor.read(bus);
        let raw = raw(&result);
        let state = ReadingState::of(&result);
        match state {
            ReadingState::Fresh(_) | ReadingState::Saturated => (self.failures, self.stale) = (0, 0),
            ReadingState::Stale => self.stale += 1,
            ReadingState::Garbled | ReadingState::Silent => self.failures += 1,
            // The registers are lost as well, so further reads are of no use.
            ReadingState::Lost => self.is_started = false,
        }
        if self.failures >= MOST_FAILURES || self.stale >= MOST_STALE {
            self.is_started = false;
        }
        BoardReading { state, raw }
    }
}

/// The bytes of a reading, as far as it has any.
fn raw<E>(result: &Result<Measurement, ReadError<E>>) -> RawRead {
    match result {
        Ok(measurement) => measurement.raw,
        Err(error) => error.raw().copied().unwrap_or(RawRead::from_bytes(&[])),
    }
}
