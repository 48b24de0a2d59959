//! Reading of a recording.

use std::collections::BTreeMap;
use std::io::Read;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use vibrissa_robot::recording::{FileMessage, FileRecord, Head, Records};
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::signal::{MAX_WHISKERS, Sample};

use super::channel::JsonChannel;
use super::error::ReadRecordingError;
use super::sample_message::SamplesMessage;
use super::setup::{KIND, Setup};
use vibrissa_text::diagnostic::Source;

/// A recording of a simulated run.
#[derive(Debug)]
pub struct RunRecording {
    pub(super) setup: Setup,
    pub(super) artifact: Artifact,
    /// The samples before each tick.
    pub(super) samples: Vec<Vec<Sample>>,
    /// The results of each tick.
    pub(super) ticks: Vec<RecordedTick>,
}

/// The results of a tick that a replay repeats. `None` is a number that is not finite.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct RecordedTick {
    pub(super) time_s: f64,
    pub(super) state: Option<String>,
    pub(super) velocity_m_s: [Option<f64>; 2],
    pub(super) yaw_rate_rad_s: Option<f64>,
    pub(super) whiskers: Vec<RecordedWhisker>,
}

/// The results of a whisker in a tick.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct RecordedWhisker {
    pub(super) whisker: String,
    pub(super) deflection_rad: Option<f64>,
    pub(super) tip_m: Option<[f64; 2]>,
    pub(super) recorded: bool,
}

/// The parts of a file that a replay needs.
#[derive(Default)]
struct Parts {
    head: Head,
    samples: Vec<Vec<u8>>,
    ticks: Vec<Vec<u8>>,
}

impl RunRecording {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ReadRecordingError`] with the first problem found.
    pub fn read(input: impl Read) -> Result<Self, ReadRecordingError> {
        let parts = Parts::read(input)?;
        if parts.head.entry("kind") != KIND {
            return Err(ReadRecordingError::Missing("metadata of a run"));
        }
        parts.head.check_format()?;
        let setup = Setup::from_head(parts.head)?;
        let artifact = Artifact::from_bytes(&setup.machine)?;
        let whiskers = setup.rig.whiskers.len();
        if !(1..=MAX_WHISKERS).contains(&whiskers) {
            return Err(ReadRecordingError::Whiskers { whiskers });
        }
        let texts = messages::<SamplesMessage>(JsonChannel::Samples, &parts.samples)?;
        let samples = texts.iter().enumerate().map(|(message, samples)| {
            samples.samples(whiskers).ok_or_else(|| ReadRecordingError::Message {
                topic: JsonChannel::Samples.topic(),
                message,
                reason: format!("a list has not one entry for each of the {whiskers} whiskers"),
            })
        });
        let samples = samples.collect::<Result<Vec<_>, _>>()?;
        let ticks = messages::<RecordedTick>(JsonChannel::Ticks, &parts.ticks)?;
        if samples.len() != ticks.len() {
            return Err(ReadRecordingError::Counts { samples: samples.len(), ticks: ticks.len() });
        }
        Ok(Self { setup, artifact, samples, ticks })
    }

    /// True if a file is a recording of a simulated run. The record that identifies it is the first one after the header of the file,
    /// unless another program has written the file anew.
    #[must_use]
    pub fn is_in(file: impl Read) -> bool {
        let mut records = Records::new(file, |_| None::<JsonChannel>);
        while let Ok(Some(record)) = records.next_record() {
            if let FileRecord::Identity(identity) = record {
                return identity.get("kind").is_some_and(|kind| kind == KIND);
            }
        }
        false
    }

    /// The recorded policy with those of the files that it uses. `None` if a compiled machine was recorded.
    #[must_use]
    pub fn policy(&self) -> Option<&Source> {
        self.setup.policy.as_ref()
    }

    /// Names and hashes that identify the run.
    #[must_use]
    pub fn identity(&self) -> &BTreeMap<String, String> {
        &self.setup.identity
    }
}

impl Parts {
    fn read(input: impl Read) -> Result<Self, ReadRecordingError> {
        let mut parts = Self::default();
        let mut records = Records::new(input, JsonChannel::named);
        while let Some(record) = records.next_record()? {
            let Some(FileMessage { channel, data, .. }) = parts.head.add(record) else { continue };
            match channel {
                JsonChannel::Samples => parts.samples.push(data),
                JsonChannel::Ticks => parts.ticks.push(data),
                _ => {}
            }
        }
        if records.is_cut() { Err(ReadRecordingError::Cut) } else { Ok(parts) }
    }
}

/// The messages of a channel.
fn messages<M: DeserializeOwned>(channel: JsonChannel, texts: &[Vec<u8>]) -> Result<Vec<M>, ReadRecordingError> {
    let read = |(message, text): (usize, &Vec<u8>)| {
        serde_json::from_slice(text).map_err(|error| ReadRecordingError::Message {
            topic: channel.topic(),
            message,
            reason: error.to_string(),
        })
    };
    texts.iter().enumerate().map(read).collect()
}
