//! The message of a step: everything that the control task has taken.

use serde::{Deserialize, Serialize};
use vibrissa_runtime::geometry::{Point2, Pose};

use super::number::Number;
use crate::array::{BoardReading, ReadingState, Round, StampedPose};
use crate::config::MAX_BOARDS;
use crate::drive::{StepInput, StepTime};
use crate::sensor::{RawRead, Sensor, SensorModel};

/// The inputs of a step of the control task.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct StepMessage {
    /// Scheduled time of the step since the start of the program (ns).
    pub(super) due_ns: u64,
    /// Start of the step (ns).
    pub(super) started_ns: u64,
    /// The last sample period of the step.
    pub(super) last_slot: u64,
    /// Time of the sample period with the number 0 (ns), on the clock of the poses.
    pub(super) origin_ns: u64,
    /// Start of the last sample period (ns), on the clock of the step. Without it, both clocks are the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "u64"))]
    pub(super) newest_ns: Option<u64>,
    /// True if the supervisor stops the robot, so that the machine waits.
    pub(super) is_paused: bool,
    /// Records that have been lost until now, because the disk was too slow.
    pub(super) lost: u64,
    /// The poses since the last step.
    pub(super) poses: Vec<PoseMessage>,
    /// The rounds since the last step.
    pub(super) rounds: Vec<RoundMessage>,
}

/// A pose of the platform in the world frame.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PoseMessage {
    /// Time of the pose since the start of the program (ns).
    time_ns: u64,
    /// Position of the centre of mass, x (m).
    x: Number,
    /// Position of the centre of mass, y (m).
    y: Number,
    /// Heading (rad), not wrapped.
    heading: Number,
}

/// One reading of every board on a bus.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct RoundMessage {
    /// Index of the bus.
    bus: u8,
    /// Number of the sample period.
    slot: u64,
    /// Start of the round (ns).
    started_ns: u64,
    /// End of the round (ns).
    ended_ns: u64,
    /// The readings in the order of the boards.
    boards: Vec<BoardMessage>,
}

/// The reading of a board.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BoardMessage {
    /// The result: `fresh`, `saturated`, `stale`, `garbled`, `silent` or `lost`.
    #[cfg_attr(test, schemars(with = "String"))]
    state: BoardState,
    /// The value in counts. 0 if it is not fresh.
    counts: i32,
    /// The bytes on the bus in hexadecimal digits: the status and the value. Empty if there were none.
    raw: String,
}

/// The result of reading a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum BoardState {
    /// A new value.
    Fresh,
    /// The field is at the end of the sensor's range.
    Saturated,
    /// No new value.
    Stale,
    /// The status byte is impossible.
    Garbled,
    /// The board does not answer.
    Silent,
    /// The board has lost its settings.
    Lost,
}

/// A reading that the driver does not decode as recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DecodingDifference {
    /// Index of the board.
    pub(super) board: usize,
    pub(super) recorded: ReadingState,
    /// The result of decoding. `None` if it is none that a robot records.
    pub(super) decoded: Option<ReadingState>,
}

impl StepMessage {
    pub(super) fn new(input: &StepInput, poses: Vec<PoseMessage>, rounds: Vec<RoundMessage>) -> Self {
        let &StepInput { due_ns, started_ns, last_slot, origin_ns, newest_ns, is_paused, lost } = input;
        let newest_ns = Some(newest_ns);
        Self { due_ns, started_ns, last_slot, origin_ns, newest_ns, is_paused, lost, poses, rounds }
    }

    /// The time of the step, under this sample period (ns).
    pub(super) fn time(&self, sample_period_ns: u64) -> StepTime {
        let time = StepTime::new(self.due_ns, self.last_slot, self.origin_ns, sample_period_ns);
        StepTime { newest_ns: self.newest_ns.unwrap_or(time.newest_ns), ..time }
    }
}

impl From<&StampedPose> for PoseMessage {
    fn from(stamped: &StampedPose) -> Self {
        let Pose { position, heading } = stamped.pose;
        Self { time_ns: stamped.time_ns, x: position.x.into(), y: position.y.into(), heading: heading.into() }
    }
}

impl From<&PoseMessage> for StampedPose {
    fn from(message: &PoseMessage) -> Self {
        let position = Point2::new(message.x.into(), message.y.into());
        Self { time_ns: message.time_ns, pose: Pose { position, heading: message.heading.into() } }
    }
}

impl From<&Round> for RoundMessage {
    fn from(round: &Round) -> Self {
        let readings = round.readings.iter().take(usize::from(round.count));
        let boards = readings.map(BoardMessage::from).collect();
        Self { bus: round.bus, slot: round.slot, started_ns: round.started_ns, ended_ns: round.ended_ns, boards }
    }
}

impl RoundMessage {
    /// The bus, with the round as the driver decodes its bytes now.
    ///
    /// # Errors
    /// [`DecodingDifference`] with the first board whose result differs from the recorded one.
    pub(crate) fn decoded(&self, sensor: &SensorModel) -> Result<Round, DecodingDifference> {
        let silent = BoardReading::without_bytes(ReadingState::Silent);
        let mut readings = [silent; MAX_BOARDS];
        let mut count = 0;
        for (board, (reading, message)) in readings.iter_mut().zip(&self.boards).enumerate() {
            let recorded = message.recorded();
            let decoded = message.decoded(sensor);
            match decoded {
                Some(decoded) if decoded.state == recorded => *reading = decoded,
                // The driver has noticed a wrap by the readings before. The bytes alone do not tell.
                Some(BoardReading { state: ReadingState::Fresh(_), raw }) if recorded == ReadingState::Saturated => {
                    *reading = BoardReading { state: recorded, raw };
                }
                _ => {
                    let decoded = decoded.map(|reading| reading.state);
                    return Err(DecodingDifference { board, recorded, decoded });
                }
            }
            count += 1;
        }
        let &Self { bus, slot, started_ns, ended_ns, .. } = self;
        Ok(Round { bus, slot, started_ns, ended_ns, count, readings })
    }

    /// The index of the bus.
    pub(crate) fn bus(&self) -> usize {
        usize::from(self.bus)
    }
}

impl From<&BoardReading> for BoardMessage {
    fn from(reading: &BoardReading) -> Self {
        let state = match reading.state {
            ReadingState::Fresh(_) => BoardState::Fresh,
            ReadingState::Saturated => BoardState::Saturated,
            ReadingState::Stale => BoardState::Stale,
            ReadingState::Garbled => BoardState::Garbled,
            ReadingState::Silent => BoardState::Silent,
            ReadingState::Lost => BoardState::Lost,
        };
        let raw = crate::hex::encode(reading.raw.as_bytes());
        Self { state, counts: reading.state.counts().unwrap_or(0), raw }
    }
}

impl BoardMessage {
    fn recorded(&self) -> ReadingState {
        match self.state {
            BoardState::Fresh => ReadingState::Fresh(self.counts),
            BoardState::Saturated => ReadingState::Saturated,
            BoardState::Stale => ReadingState::Stale,
            BoardState::Garbled => ReadingState::Garbled,
            BoardState::Silent => ReadingState::Silent,
            BoardState::Lost => ReadingState::Lost,
        }
    }

    /// The reading by the driver's decoding. `None` if the bytes are no hexadecimal digits, or absent where the bus has
    /// answered.
    fn decoded(&self, sensor: &SensorModel) -> Option<BoardReading> {
        let bytes = crate::hex::decode(&self.raw)?;
        let raw = RawRead::from_bytes(&bytes);
        let state = match (bytes.is_empty(), self.recorded()) {
            (false, _) => sensor.decode(&bytes),
            // The bus has reported an error, or the board was not read.
            (true, recorded @ (ReadingState::Silent | ReadingState::Lost)) => recorded,
            (true, _) => return None,
        };
        Some(BoardReading { state, raw })
    }
}
