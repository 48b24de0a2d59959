//! An emulated sensor.

use crate::answer::Answer;
use crate::counts::{end_word, field_word, temperature_word};
use crate::emulated::Emulated;
use crate::fault::{SensorFault, count_down};
use crate::field::FieldSource;
use crate::mode::{Mode, Schedule};
use crate::options::SensorOptions;
use crate::registers::Registers;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// Time after a reset, during which the sensor does not answer (ns). It is the data sheet's longest.
const RESET_NS: u64 = 1_500_000;
/// Time of storing the registers (ns).
const STORE_NS: u64 = 15_000_000;
/// Number of points in time at which the field is evaluated per conversion of an axis.
const POINTS: u32 = 4;

const BURST: u8 = 0x80;
const SINGLE: u8 = 0x20;
const ERROR: u8 = 0x10;
const CORRECTED_BIT: u8 = 0x08;
const RESET: u8 = 0x04;

/// An emulated MLX90393. It is on an [`EmulatedBus`](crate::EmulatedBus), which drives it.
///
/// After its creation, it is as after power-on: idle, with the stored registers, and the next status reports the reset.
#[derive(Debug, Clone)]
pub struct EmulatedSensor {
    options: SensorOptions,
    noise: ChaCha8Rng,
    registers: Registers,
    stored: Registers,
    mode: Mode,
    /// Number of starts of a mode. It separates the noise of conversions with the same number.
    starts: u64,
    /// Number of the last set that was read in this mode.
    read_set: Option<u64>,
    /// The last words of T, X, Y and Z.
    words: [u16; 4],
    reset: bool,
    busy_until_ns: u64,
    answer: Answer,
    faults: Vec<SensorFault>,
    stopped_since_ns: Option<u64>,
}

impl EmulatedSensor {
    /// Creates a sensor at power-on.
    #[must_use]
    pub fn new(options: SensorOptions) -> Self {
        let registers = Registers::new(options.factory_trim);
        // Sensors with the same seed have different noise.
        let seed = options.seed ^ (options.field_index as u64) << 40 ^ u64::from(options.address) << 56;
        Self {
            noise: ChaCha8Rng::seed_from_u64(seed),
            stored: registers.clone(),
            registers,
            mode: Mode::Idle,
            starts: 0,
            read_set: None,
            words: [0; 4],
            reset: true,
            busy_until_ns: 0,
            answer: Answer::status(0),
            faults: Vec::new(),
            stopped_since_ns: None,
            options,
        }
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &SensorOptions {
        &self.options
    }

    /// A register from 0x00 to 0x1F, or `None` at other addresses.
    #[must_use]
    pub fn register(&self, address: u8) -> Option<u16> {
        self.registers.get(address)
    }

    /// True if bits 15 to 9 of register 0 are as they were calibrated in the factory.
    #[must_use]
    pub fn factory_trim_is_intact(&self) -> bool {
        self.registers.factory_trim() == u16::from(self.options.factory_trim & 0x7F)
    }

    /// The state after power-on.
    fn restart(&mut self, now_ns: u64) {
        self.registers = self.stored.clone();
        self.enter(Mode::Idle);
        self.reset = true;
        self.busy_until_ns = now_ns + RESET_NS;
        self.words = [0; 4];
        self.answer = Answer::status(0);
    }

    fn enter(&mut self, mode: Mode) {
        self.mode = mode;
        self.read_set = None;
    }

    /// Starts to convert quantities. Without any, those of register 1 are meant.
    fn start(&mut self, nibble: u8, now_ns: u64, mode: fn(Schedule) -> Mode) -> bool {
        let axes = if nibble == 0 { self.registers.burst_axes() } else { nibble };
        if axes == 0 {
            return false;
        }
        self.starts += 1;
        let schedule = Schedule::new(&self.registers, axes, now_ns, self.options.clock_ratio);
        self.enter(mode(schedule));
        if self.stopped_since_ns.is_some() {
            self.stopped_since_ns = Some(now_ns);
        }
        true
    }

    /// The number of the last set that has ended.
    fn last_set(&self, now_ns: u64) -> Option<u64> {
        let time_ns = self.stopped_since_ns.map_or(now_ns, |stopped_ns| stopped_ns.min(now_ns));
        match &self.mode {
            Mode::Idle => None,
            Mode::Burst(schedule) => schedule.last_set(time_ns),
            Mode::Single(schedule) => schedule.last_set(time_ns).map(|_| 0),
        }
    }

    /// The bits of the status that report the mode.
    fn mode_bits(&self, now_ns: u64) -> u8 {
        match self.mode {
            Mode::Burst(_) => BURST,
            Mode::Single(_) if self.last_set(now_ns).is_none() => SINGLE,
            Mode::Idle | Mode::Single(_) => 0,
        }
    }

    /// The answer to a read of a measurement.
    fn measurement(&mut self, nibble: u8, now_ns: u64, field: &mut dyn FieldSource) -> Answer {
        let requested = if nibble == 0 { self.registers.burst_axes() } else { nibble };
        let last = self.last_set(now_ns);
        let fresh = last > self.read_set && requested != 0;
        if let Some(set) = last
            && fresh
        {
            self.read_set = last;
            if !self.faults.contains(&SensorFault::Frozen) {
                self.convert(set, requested, field);
            }
        }
        let count = u8::try_from(requested.count_ones()).unwrap_or(4);
        let error = if fresh { 0 } else { ERROR };
        let mut answer = Answer::status(self.mode_bits(now_ns) | error | count.saturating_sub(1));
        for (index, word) in self.words.into_iter().enumerate() {
            if requested >> index & 1 != 0 {
                answer.push(word);
            }
        }
        answer
    }

    /// Evaluates the requested quantities of a set.
    fn convert(&mut self, set: u64, requested: u8, field: &mut dyn FieldSource) {
        let (Mode::Burst(schedule) | Mode::Single(schedule)) = &self.mode else { return };
        let noise = self.noise_microtesla(set);
        let available = requested & schedule.axes;
        if available & 1 != 0 {
            self.words[0] = temperature_word(self.options.temperature_celsius);
        }
        for (axis, noise_microtesla) in noise.into_iter().enumerate() {
            if available >> (axis + 1) & 1 == 0 {
                continue;
            }
            let (start_ns, duration_ns) = schedule.axis_window(set, axis);
            let step_ns = duration_ns / f64::from(POINTS);
            let sum: f64 = (0..POINTS)
                .map(|point| {
                    let time_ns = start_ns + (f64::from(point) + 0.5) * step_ns;
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a time after 0")]
                    let time_ns = time_ns as u64;
                    field.field_microtesla(self.options.field_index, time_ns)[axis]
                })
                .sum();
            let middle_s = 1e-9 * (start_ns + 0.5 * duration_ns);
            let drift = self.options.offset_drift_microtesla_per_second[axis] * middle_s;
            let offset = self.options.offset_microtesla[axis] + drift + self.fault_microtesla(axis);
            let microtesla = sum / f64::from(POINTS) + offset + noise_microtesla;
            self.words[axis + 1] = match self.saturated() {
                Some(negative) => end_word(&self.registers, axis, negative),
                None => field_word(&self.registers, axis, microtesla),
            };
        }
    }

    /// The noise of a set along each axis (µT).
    fn noise_microtesla(&self, set: u64) -> [f64; 3] {
        let deviation = self.options.noise_microtesla;
        if deviation.iter().all(|deviation| *deviation <= 0.0) {
            return [0.0; 3];
        }
        let mut noise = self.noise.clone();
        noise.set_stream(self.starts << 40 ^ set);
        deviation.map(|deviation| {
            let standard: f64 = StandardNormal.sample(&mut noise);
            deviation * standard
        })
    }

    /// The end of the output range at which a fault holds all axes: true for the negative one.
    fn saturated(&self) -> Option<bool> {
        self.faults.iter().find_map(|fault| match fault {
            SensorFault::Saturated { negative } => Some(*negative),
            _ => None,
        })
    }

    /// The field that faults add along an axis (µT).
    fn fault_microtesla(&self, axis: usize) -> f64 {
        self.faults
            .iter()
            .map(|fault| match fault {
                SensorFault::OffsetJump { microtesla } => microtesla[axis],
                _ => 0.0,
            })
            .sum()
    }
}

impl Emulated for EmulatedSensor {
    fn address(&self) -> u8 {
        self.options.address
    }

    /// Adds a fault at a time (ns).
    fn inject(&mut self, fault: SensorFault, now_ns: u64) {
        match fault {
            SensorFault::BrownOut => self.restart(now_ns),
            SensorFault::ModeLost => self.enter(Mode::Idle),
            SensorFault::ClockStopped => self.stopped_since_ns = self.stopped_since_ns.or(Some(now_ns)),
            _ => self.faults.push(fault),
        }
    }

    /// Removes all faults at a time (ns).
    fn clear(&mut self, now_ns: u64) {
        self.faults.clear();
        if let Some(since_ns) = self.stopped_since_ns.take()
            && let Mode::Burst(schedule) | Mode::Single(schedule) = &mut self.mode
        {
            schedule.postpone(now_ns.saturating_sub(since_ns));
        }
    }

    /// True if the sensor acknowledges its address at a time (ns).
    fn acknowledges(&mut self, now_ns: u64) -> bool {
        let mut silent = false;
        self.faults.retain_mut(|fault| match fault {
            SensorFault::NoAcknowledge { transactions } => {
                let lasts = count_down(transactions);
                silent |= lasts;
                lasts
            }
            _ => true,
        });
        !silent && now_ns >= self.busy_until_ns
    }

    /// Executes a command that ends at a time (ns).
    fn write(&mut self, command: &[u8], now_ns: u64, field: &mut dyn FieldSource) {
        let idle = self.mode_bits(now_ns) == 0;
        let accepted = match *command {
            // Only the address, or no operation.
            [] | [0x00] => true,
            [code @ 0x10..=0x1F] if idle => self.start(code & 0xF, now_ns, Mode::Burst),
            [code @ 0x30..=0x3F] if idle => self.start(code & 0xF, now_ns, Mode::Single),
            [code @ 0x40..=0x4F] => {
                self.answer = self.measurement(code & 0xF, now_ns, field);
                return;
            }
            [0x50, address] if idle => match self.registers.get(address >> 2) {
                Some(value) => {
                    self.answer = Answer::status(0);
                    self.answer.push(value);
                    return;
                }
                None => false,
            },
            [0x60, high, low, address] if idle => self.registers.set(address >> 2, u16::from_be_bytes([high, low])),
            [0x80] => {
                self.enter(Mode::Idle);
                true
            }
            [0xD0] if idle => {
                self.registers = self.stored.clone();
                true
            }
            [0xE0] if idle => {
                self.stored = self.registers.clone();
                self.busy_until_ns = now_ns + STORE_NS;
                true
            }
            [0xF0] => {
                self.restart(now_ns);
                true
            }
            _ => false,
        };
        self.answer = Answer::status(self.mode_bits(now_ns) | if accepted { 0 } else { ERROR });
    }

    /// A byte of the answer. Index 0 is the status.
    fn read(&mut self, index: usize) -> u8 {
        let mut byte = self.answer.byte(index);
        if index == 0 {
            byte |= if self.reset { RESET } else { 0 };
            byte |= if self.faults.contains(&SensorFault::CorrectedBit) { CORRECTED_BIT } else { 0 };
            self.reset = false;
        }
        for fault in &self.faults {
            if let SensorFault::BitFlip { byte: flipped, mask, answers: 1.. } = *fault
                && flipped == index
            {
                byte ^= mask;
            }
        }
        byte
    }

    /// Ends a read at a time (ns). Another read without a command has only a status.
    fn end_read(&mut self, now_ns: u64) {
        for fault in &mut self.faults {
            if let SensorFault::BitFlip { answers, .. } = fault {
                *answers = answers.saturating_sub(1);
            }
        }
        self.answer = Answer::status(self.mode_bits(now_ns));
    }
}
