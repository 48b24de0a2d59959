//! Acquisition: the thread of one bus, which reads every board once per sample period.

use super::bus::Bus;
use super::round::{BoardReading, ReadingState, Round};
use crate::config::{BoardConfig, MAX_BOARDS};
use crate::sensor::{BoardDriver, Refused, Sensor, SensorDriver, SensorModel};

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
    address: u8,
    driver: BoardDriver,
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
    /// [`Refused`] if a board has an address that the sensor cannot have.
    pub fn new(bus: u8, boards: &[BoardConfig], sensor: &SensorModel) -> Result<Self, Refused> {
        let board = |address| {
            let driver = sensor.driver(address)?;
            Ok(Board { address, driver, is_started: false, failures: 0, stale: 0, retry_ns: 0 })
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
            board.start(bus).map_err(|Refused(message)| StartFault { address: board.address, message })?;
        }
        Ok(())
    }

    /// Reads every board once. It waits for nothing, except that it brings up a lost board again.
    pub fn round<B: Bus>(&mut self, slot: u64, bus: &mut B) -> Round {
        let silent = BoardReading::without_bytes(ReadingState::Silent);
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
    fn start<B: Bus>(&mut self, bus: &mut B) -> Result<(), Refused> {
        self.driver.start(bus)?;
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
            return BoardReading::without_bytes(ReadingState::Lost);
        }
        let reading = self.driver.read(bus);
        match reading.state {
            ReadingState::Fresh(_) | ReadingState::Saturated => (self.failures, self.stale) = (0, 0),
            ReadingState::Stale => self.stale += 1,
            ReadingState::Garbled | ReadingState::Silent => self.failures += 1,
            // The registers are lost as well, so further reads are of no use.
            ReadingState::Lost => self.is_started = false,
        }
        if self.failures >= MOST_FAILURES || self.stale >= MOST_STALE {
            self.is_started = false;
        }
        reading
    }
}
