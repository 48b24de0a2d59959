//! Errors of recordings.

use thiserror::Error;
use vibrissa_robot::recording::ReadError;
use vibrissa_runtime::control::BindError;
use vibrissa_runtime::machine::ArtifactError;

/// A run that cannot be recorded.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The machine cannot be encoded.
    #[error(transparent)]
    Artifact(#[from] ArtifactError),
    /// The rig does not have what the policy needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// A value cannot be encoded.
    #[error("a value cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The file cannot be encoded.
    #[error("the recording cannot be written: {0}")]
    Mcap(String),
    /// The text of the policy has errors, although it was compiled before.
    #[error("the guards of the policy cannot be explained")]
    Explain,
    /// The run ended before the first tick.
    #[error("there is nothing to record, because the run had no tick")]
    NoTick,
    /// The system starts no thread, or the thread ended early.
    #[error("the thread that writes the recording ended: {0}")]
    Thread(String),
}

impl From<foxglove::FoxgloveError> for RecordError {
    fn from(error: foxglove::FoxgloveError) -> Self {
        Self::Mcap(error.to_string())
    }
}

/// A file that cannot be replayed.
#[derive(Debug, Error)]
pub enum ReadRecordingError {
    /// The file cannot be read, or it is damaged.
    #[error(transparent)]
    File(#[from] ReadError),
    /// The file ends within a record.
    #[error("its end is missing; copy it again")]
    Cut,
    /// Something that every recording of a run has is missing.
    #[error("it has no {0}, so it is no recording of a run; `vibrissa run SCENARIO --record FILE` makes one")]
    Missing(&'static str),
    /// The machine is not valid.
    #[error("its machine cannot be used: {0}")]
    Artifact(#[from] ArtifactError),
    /// The rig does not have what the machine needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// A message is not valid.
    #[error("message {message} of `{topic}` is not valid: {reason}")]
    Message {
        /// The topic.
        topic: &'static str,
        /// Number of the message in its channel, from 0.
        message: usize,
        /// What is wrong.
        reason: String,
    },
    /// The rig has no whiskers, or too many.
    #[error("its rig has {whiskers} whiskers; a rig has 1 to {}", vibrissa_runtime::signal::MAX_WHISKERS)]
    Whiskers {
        /// The number of whiskers.
        whiskers: usize,
    },
    /// The numbers of samples and of ticks differ.
    #[error("it has {samples} messages of samples and {ticks} ticks; record the run again")]
    Counts {
        /// The number of messages of samples.
        samples: usize,
        /// The number of ticks.
        ticks: usize,
    },
}
