//! Sensor IO for a microcontroller: it reads the sensors of one bus over `embedded-hal`, and writes the message `inputs` of each control
//! period for `vibrissa-robot control`.
//!
//! It needs neither `std` nor an allocator. The caller has the bus, a clock in nanoseconds, and a client for MQTT.

use core::fmt::{self, Write};

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use vibrissa_mlx90393::{Address, Axis, CheckedSettings, Measurement, RawRead, ReadError, Sensor};

/// Sample rate and control rate (Hz) of the reference rig.
const SAMPLE_RATE: u64 = 300;
const CONTROL_RATE: u64 = 30;
/// Rounds of a message.
const ROUNDS: usize = (SAMPLE_RATE / CONTROL_RATE) as usize;
/// Poses that a message has at most. Older ones are dropped.
const POSES: usize = 8;
/// Bytes of a message of three boards. It is the size of the buffer for [`SensorIo::message`].
pub const MESSAGE_BYTES: usize = 4096;
/// A number of a pose that is farther ahead than this is none of the sequence.
const LARGEST_STEP: u64 = 1 << 32;
/// Reads in a row that fail or have no new value, after which a sensor is started again: a tenth of a second.
const MOST_FAILURES: u8 = 30;

/// The result of a read, by its name in the message.
#[derive(Clone, Copy)]
struct Reading {
    state: &'static str,
    counts: i32,
    raw: Option<RawRead>,
}

/// One reading of every board.
#[derive(Clone, Copy)]
struct Round<const BOARDS: usize> {
    slot: u64,
    started_ns: u64,
    ended_ns: u64,
    readings: [Reading; BOARDS],
}

/// A pose as it arrived.
#[derive(Clone, Copy)]
struct ReceivedPose {
    time_ns: u64,
    x: f64,
    y: f64,
    heading: f64,
}

struct Board {
    sensor: Sensor,
    is_started: bool,
    failures: u8,
}

/// The readings and poses since the last message.
pub struct SensorIo<const BOARDS: usize> {
    boards: [Board; BOARDS],
    /// Another number for each run, in microseconds since 1970 if the time is known.
    session: u64,
    origin_ns: u64,
    rounds: [Round<BOARDS>; ROUNDS],
    round_count: usize,
    poses: [ReceivedPose; POSES],
    pose_count: usize,
    pose_number: Option<u64>,
    /// The sample period of the newest round.
    newest_slot: Option<u64>,
    /// The last sample period of a message that was not written yet.
    is_due: Option<u64>,
}

impl<const BOARDS: usize> SensorIo<BOARDS> {
    /// The boards at these addresses, in the order of the configuration of the robot. The sample period 0 begins at `origin_ns`.
    pub fn new(addresses: [Address; BOARDS], settings: CheckedSettings, session: u64, origin_ns: u64) -> Self {
        let silent = Reading { state: "silent", counts: 0, raw: None };
        let boards =
            addresses.map(|address| Board { sensor: Sensor::new(address, settings), is_started: false, failures: 0 });
        Self {
            boards,
            session,
            origin_ns,
            rounds: [Round { slot: 0, started_ns: 0, ended_ns: 0, readings: [silent; BOARDS] }; ROUNDS],
            round_count: 0,
            poses: [ReceivedPose { time_ns: 0, x: 0.0, y: 0.0, heading: 0.0 }; POSES],
            pose_count: 0,
            pose_number: None,
            newest_slot: None,
            is_due: None,
        }
    }

    /// The time (ns) at which the next round begins.
    pub fn due_ns(&self) -> u64 {
        let slot = self.newest_slot.map_or(0, |slot| slot + 1);
        self.origin_ns + (slot * 1_000_000_000).div_ceil(SAMPLE_RATE)
    }

    /// Reads every board once. Call it at [`due_ns`](Self::due_ns). Sample periods that were missed are left out.
    ///
    /// A sensor that has lost its settings is started again, which takes some milliseconds.
    pub fn round<I: I2c>(&mut self, bus: &mut I, delay: &mut impl DelayNs, mut now_ns: impl FnMut() -> u64) {
        let started_ns = now_ns();
        let slot = started_ns.saturating_sub(self.origin_ns) * SAMPLE_RATE / 1_000_000_000;
        let mut readings = [Reading { state: "silent", counts: 0, raw: None }; BOARDS];
        for (board, reading) in self.boards.iter_mut().zip(&mut readings) {
            *reading = board.read(bus, delay);
        }
        if self.newest_slot.is_some_and(|newest| slot / ROUNDS as u64 > newest / ROUNDS as u64) && self.is_due.is_some()
        {
            // The last message was never fetched, and its rounds are too old now.
            (self.round_count, self.is_due) = (0, None);
        }
        self.newest_slot = Some(slot);
        if let Some(round) = self.rounds.get_mut(self.round_count) {
            *round = Round { slot, started_ns, ended_ns: now_ns(), readings };
            self.round_count += 1;
        }
        if (slot + 1).is_multiple_of(ROUNDS as u64) || self.round_count == ROUNDS {
            self.is_due = Some(slot);
        }
    }

    /// Takes a packet of the localisation that arrives at `now_ns`. One out of order, or with numbers that are not finite, is ignored.
    pub fn pose(&mut self, packet: &[u8], now_ns: u64) {
        let word = |index: usize| packet.get(4 + 8 * index..)?.first_chunk().copied().map(u64::from_le_bytes);
        let (true, Some(number)) = (packet.len() == 36 && packet.starts_with(b"VBP1"), word(0)) else { return };
        if self.pose_number.is_some_and(|last| number <= last || number - last > LARGEST_STEP) {
            return;
        }
        let [x, y, heading] = [1, 2, 3].map(|index| word(index).map_or(f64::NAN, f64::from_bits));
        if !(x.is_finite() && y.is_finite() && heading.is_finite()) {
            return;
        }
        self.pose_number = Some(number);
        if self.pose_count == POSES {
            self.poses.rotate_left(1);
            self.pose_count -= 1;
        }
        if let Some(pose) = self.poses.get_mut(self.pose_count) {
            *pose = ReceivedPose { time_ns: now_ns, x, y, heading };
            self.pose_count += 1;
        }
    }

    /// The message `inputs`, once after each control period, or `None`. Send it to `vibrissa/NAME/sensor_io/inputs` with the quality of service 0.
    pub fn message<'b>(&mut self, now_ns: u64, buffer: &'b mut [u8; MESSAGE_BYTES]) -> Option<&'b str> {
        let last_slot = self.is_due.take()?;
        let mut text = Text { buffer, length: 0 };
        let written = self.write(&mut text, now_ns, last_slot);
        (self.round_count, self.pose_count) = (0, 0);
        let Text { buffer, length } = text;
        written.ok().and_then(|()| core::str::from_utf8(buffer.get(..length)?).ok())
    }

    fn write(&self, text: &mut impl Write, now_ns: u64, last_slot: u64) -> fmt::Result {
        let Self { session, origin_ns, .. } = self;
        write!(
            text,
            r#"{{"session":{session},"sample_rate_hz":{SAMPLE_RATE}.0,"control_rate_hz":{CONTROL_RATE}.0,"sent_ns":{now_ns},"#
        )?;
        write!(text, r#""last_slot":{last_slot},"origin_ns":{origin_ns},"rounds":["#)?;
        for (index, round) in self.rounds.iter().take(self.round_count).enumerate() {
            let Round { slot, started_ns, ended_ns, readings } = round;
            let comma = if index == 0 { "" } else { "," };
            write!(
                text,
                r#"{comma}{{"bus":0,"slot":{slot},"started_ns":{started_ns},"ended_ns":{ended_ns},"boards":["#
            )?;
            for (index, Reading { state, counts, raw }) in readings.iter().enumerate() {
                let comma = if index == 0 { "" } else { "," };
                write!(text, r#"{comma}{{"state":"{state}","counts":{counts},"raw":""#)?;
                raw.iter().flat_map(RawRead::as_bytes).try_for_each(|byte| write!(text, "{byte:02x}"))?;
                text.write_str(r#""}"#)?;
            }
            text.write_str("]}")?;
        }
        text.write_str(r#"],"poses":["#)?;
        for (index, ReceivedPose { time_ns, x, y, heading }) in self.poses.iter().take(self.pose_count).enumerate() {
            let comma = if index == 0 { "" } else { "," };
            write!(text, r#"{comma}{{"time_ns":{time_ns},"x":{x:?},"y":{y:?},"heading":{heading:?}}}"#)?;
        }
        text.write_str("]}")
    }
}

impl Board {
    fn read<I: I2c>(&mut self, bus: &mut I, delay: &mut impl DelayNs) -> Reading {
        if !self.is_started {
            self.is_started = self.sensor.start(bus, delay).is_ok();
            self.failures = 0;
            // The first value comes with the next round.
            return Reading { state: "lost", counts: 0, raw: None };
        }
        let read = self.sensor.read(bus);
        let raw = match &read {
            Ok(Measurement { raw, .. }) => Some(*raw),
            Err(error) => error.raw().copied(),
        };
        let counts = read.as_ref().ok().and_then(|measurement| measurement.counts(Axis::Y)).unwrap_or(0);
        let state = match &read {
            Ok(measurement) if measurement.is_saturated(Axis::Y) => "saturated",
            Ok(_) => "fresh",
            Err(ReadError::Stale { .. }) => "stale",
            Err(ReadError::Garbled { .. }) => "garbled",
            Err(ReadError::ModeLost { .. } | ReadError::Reset { .. }) => "lost",
            Err(ReadError::Bus(_)) => "silent",
        };
        self.failures = if read.is_ok() { 0 } else { self.failures + 1 };
        self.is_started = state != "lost" && self.failures < MOST_FAILURES;
        Reading { state, counts: if state == "fresh" { counts } else { 0 }, raw }
    }
}

/// Text in a buffer.
struct Text<'b> {
    buffer: &'b mut [u8],
    length: usize,
}

impl Write for Text<'_> {
    fn write_str(&mut self, part: &str) -> fmt::Result {
        let end = self.length + part.len();
        self.buffer.get_mut(self.length..end).ok_or(fmt::Error)?.copy_from_slice(part.as_bytes());
        self.length = end;
        Ok(())
    }
}
