//! Assembly of the rounds of all buses to samples.

use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

use super::magnet::Magnet;
use super::pose_history::PoseHistory;
use super::round::Round;
use super::transducer::Transducer;
use super::zeroing::Zeroing;
use crate::config::{Config, MAX_BOARDS, MAX_BUSES, MAX_ROUNDS};
use crate::sensor::{Sensor, SensorModel};

/// Number of sample periods that are kept until all buses have delivered.
const SLOTS: usize = 2 * MAX_ROUNDS as usize;

/// Assembles rounds to samples: counts to base angles, and the pose at the time of the sample.
#[derive(Debug, Clone)]
pub struct Assembler {
    /// For each board on each bus, the index of its whisker.
    whisker: [[Option<usize>; MAX_BOARDS]; MAX_BUSES],
    transducers: [Transducer; MAX_WHISKERS],
    /// The counts of the newest sample periods. The entry of a period is its number modulo [`SLOTS`].
    slots: [Slot; SLOTS],
    /// The next sample period that becomes a sample.
    next_slot: u64,
    period_ns: u64,
    /// Age of a value when it is read (ns): half of a conversion for its mean age, and half for its mean.
    delay_ns: u64,
    samples: Vec<Sample>,
    zeroing: Zeroing,
    /// Readings that came after their sample.
    late: u64,
}

/// The counts of a sample period.
#[derive(Debug, Clone, Copy, Default)]
struct Slot {
    /// Number of the period. Entries of older periods have no values for it.
    number: u64,
    counts: [Option<i32>; MAX_WHISKERS],
}

impl Assembler {
    /// The assembler of an array with these sensors.
    #[must_use]
    pub fn new(config: &Config, sensor: &SensorModel) -> Self {
        let none = Transducer {
            magnet: Magnet { field_per_moment: 1.0, cubic: 0.0 },
            microtesla_per_count: sensor.microtesla_per_count(),
            hinge_stiffness: 1.0,
            neutral: 0.0,
        };
        let (mut whisker, mut transducers) = ([[None; MAX_BOARDS]; MAX_BUSES], [none; MAX_WHISKERS]);
        for (bus, board, index) in config.boards() {
            let entry = config.buses.get(bus).and_then(|bus| bus.boards.get(board));
            let cell = whisker.get_mut(bus).and_then(|boards| boards.get_mut(board));
            let transducer = transducers.get_mut(index);
            let rig = config.rig.whiskers.get(index);
            if let (Some(entry), Some(cell), Some(transducer), Some(rig)) = (entry, cell, transducer, rig) {
                *cell = Some(index);
                *transducer = Transducer::new(entry, rig, sensor);
            }
        }
        Self {
            whisker,
            transducers,
            slots: [Slot::default(); SLOTS],
            next_slot: 0,
            period_ns: period_ns(config.rig.sensing.sample_rate),
            delay_ns: u64::from(sensor.conversion_us()) * 1000,
            samples: Vec::with_capacity(SLOTS),
            zeroing: Zeroing::new(config.rig.whiskers.len(), sensor.largest_rest_spread()),
            late: 0,
        }
    }

    /// The whiskers of a round with their counts, if they are new.
    pub fn counts<'a>(&'a self, round: &'a Round) -> impl Iterator<Item = (usize, Option<i32>)> + 'a {
        let boards = self.whisker.get(usize::from(round.bus)).into_iter().flatten();
        let readings = round.readings.iter().take(usize::from(round.count));
        boards.zip(readings).filter_map(|(whisker, reading)| whisker.map(|index| (index, reading.state.counts())))
    }

    /// The measurement of the neutral values, before its first value.
    #[must_use]
    pub fn zeroing(&self) -> Zeroing {
        self.zeroing.clone()
    }

    /// Sets the neutral values (counts) of all whiskers.
    pub fn set_neutral(&mut self, neutral: [f64; MAX_WHISKERS]) {
        for (transducer, neutral) in self.transducers.iter_mut().zip(neutral) {
            transducer.neutral = neutral;
        }
    }

    /// The field (T) and the base angle (rad) of a whisker at a value (counts). The base angle is relative to the neutral
    /// value.
    #[must_use]
    pub fn values(&self, whisker: usize, counts: i32) -> Option<(f64, f64)> {
        let transducer = self.transducers.get(whisker)?;
        Some((f64::from(counts) * transducer.microtesla_per_count * 1e-6, transducer.base_angle(f64::from(counts))))
    }

    /// Drops all sample periods before `slot`.
    pub fn skip_to(&mut self, slot: u64) {
        self.next_slot = self.next_slot.max(slot);
    }

    /// Adds a round. Its values are dropped if its sample period has become a sample already.
    pub fn take(&mut self, round: &Round) {
        if round.slot < self.next_slot {
            self.late += 1;
            return;
        }
        let mut values = [None; MAX_WHISKERS];
        for (whisker, counts) in self.counts(round) {
            if let Some(value) = values.get_mut(whisker) {
                *value = counts;
            }
        }
        if let Some(slot) = self.slots.get_mut(cell(round.slot)) {
            if slot.number != round.slot {
                *slot = Slot { number: round.slot, ..Slot::default() };
            }
            for (kept, value) in slot.counts.iter_mut().zip(values) {
                *kept = value.or(*kept);
            }
        }
    }

    /// The samples of all periods until `last_slot`, oldest first. Period 0 begins at `origin_ns`, and `paused_ns` is the
    /// time after it that does not count. A whisker without a new value has the base angle NaN. The function allocates
    /// no memory.
    pub fn samples(&mut self, last_slot: u64, poses: &PoseHistory, origin_ns: u64, paused_ns: u64) -> &[Sample] {
        self.samples.clear();
        // After a long gap, older periods than the ring has are gone.
        self.next_slot = self.next_slot.max((last_slot + 1).saturating_sub(SLOTS as u64));
        while self.next_slot <= last_slot {
            let slot = self.slots.get(cell(self.next_slot)).filter(|slot| slot.number == self.next_slot);
            let counts = slot.map_or([None; MAX_WHISKERS], |slot| slot.counts);
            let read_ns = self.next_slot * self.period_ns;
            let time_ns = read_ns.saturating_sub(self.delay_ns);
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            for ((reading, counts), transducer) in whiskers.iter_mut().zip(counts).zip(&self.transducers) {
                reading.base_angle = counts.map_or(f64::NAN, |counts| transducer.base_angle(f64::from(counts)));
            }
            let time = time_ns.saturating_sub(paused_ns) as f64 * 1e-9;
            self.samples.push(Sample { time, body: poses.at(origin_ns + time_ns), whiskers });
            self.next_slot += 1;
        }
        &self.samples
    }

    /// The samples that [`samples`](Self::samples) has returned last.
    #[must_use]
    pub fn newest_samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Age (ns) of a value when it is read.
    #[must_use]
    pub fn delay_ns(&self) -> u64 {
        self.delay_ns
    }

    /// Rounds that came after their sample.
    #[must_use]
    pub fn late(&self) -> u64 {
        self.late
    }
}

/// Entry of a sample period in the ring.
fn cell(slot: u64) -> usize {
    #[expect(clippy::cast_possible_truncation, reason = "below the length of the ring")]
    let cell = (slot % SLOTS as u64) as usize;
    cell
}

/// The period of a rate (Hz), in whole nanoseconds.
#[must_use]
pub fn period_ns(rate: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated rate")]
    let period = (1e9 / rate).round() as u64;
    period
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::array::{BoardReading, ReadingState};
    use vibrissa_runtime::rig::Rig;

    fn assembler() -> Assembler {
        let config = Config::emulated(Rig::default(), 1.5);
        Assembler::new(&config, &config.sensor().unwrap())
    }

    fn round(bus: u8, slot: u64, state: ReadingState) -> Round {
        let reading = BoardReading::without_bytes(state);
        Round { bus, slot, started_ns: 0, ended_ns: 0, count: 1, readings: [reading; MAX_BOARDS] }
    }

    #[test]
    fn the_buses_of_a_period_make_one_sample_and_a_missing_one_makes_nan() {
        let mut assembler = assembler();
        assembler.take(&round(0, 0, ReadingState::Fresh(1000)));
        assembler.take(&round(1, 0, ReadingState::Fresh(-1000)));
        assembler.take(&round(0, 1, ReadingState::Stale));
        let samples = assembler.samples(1, &PoseHistory::new(0), 0, 0).to_vec();
        let angles = |sample: &Sample| [sample.whiskers[0].base_angle, sample.whiskers[1].base_angle];
        let [right, left] = angles(&samples[0]);
        // 1000 counts of 0.15 µT under 4.38 µT per µN m, with a hinge of 1 N m/rad.
        assert!((right - 150e-6 / 4.38).abs() < 1e-9 && (left + right).abs() < 1e-15, "{right} {left}");
        assert!(angles(&samples[1]).iter().all(|angle| angle.is_nan()));
    }

    #[test]
    fn a_value_of_a_skipped_period_never_becomes_a_later_sample() {
        let mut assembler = assembler();
        for slot in 0..10 {
            assembler.take(&round(0, slot, ReadingState::Fresh(1000)));
        }
        assembler.skip_to(10);
        let samples = assembler.samples(SLOTS as u64 + 9, &PoseHistory::new(0), 0, 0);
        assert!(samples.iter().all(|sample| sample.whiskers[0].base_angle.is_nan()));
    }

    #[test]
    fn a_round_after_its_sample_is_late() {
        let mut assembler = assembler();
        assembler.samples(5, &PoseHistory::new(0), 0, 0);
        assembler.take(&round(0, 5, ReadingState::Fresh(1000)));
        assert_eq!(assembler.late(), 1);
    }
}
