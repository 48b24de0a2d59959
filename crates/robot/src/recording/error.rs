//! Errors of recordings.

use mcap::McapError;
use vibrissa_runtime::control::BindError;
use vibrissa_text::system::in_words;

use super::head::FORMAT;
use super::setup::SetupError;
use crate::config::ConfigError;

/// A recording that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The disk does not take it.
    #[error("{words}", words = in_words(.0))]
    Disk(#[from] std::io::Error),
    /// The MCAP library refuses it.
    #[error("{0}")]
    Mcap(McapError),
    /// The setup cannot be written.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A message cannot be written as JSON.
    #[error("a message cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// One file does not fit into the limit.
    #[error(
        "the limit of {limit_bytes} bytes is too small for a recording with this machine; raise `limit_mb` in the \
         section `record`"
    )]
    Limit {
        /// The limit of the directory.
        limit_bytes: u64,
    },
}

impl From<McapError> for WriteError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(error) => Self::Disk(error),
            other => Self::Mcap(other),
        }
    }
}

/// A recording that cannot be read or replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be read.
    #[error("it cannot be read: {words}", words = in_words(.0))]
    Disk(#[from] std::io::Error),
    /// The file is no MCAP file.
    #[error("it is no MCAP file; give a recording of `vibrissa-robot` or of `vibrissa drive --record`")]
    NotMcap,
    /// The file is an MCAP file of another program.
    #[error(
        "it is an MCAP file of another program; give a recording of `vibrissa-robot` or of `vibrissa drive --record`"
    )]
    Foreign,
    /// The file ends before the first message.
    #[error("it ends before its first message; nothing of it can be used")]
    Empty,
    /// The recording has another format.
    #[error(
        "it is a recording in format {found}, this program reads format {FORMAT}; use the program that recorded it"
    )]
    Format {
        /// Version of that format.
        found: String,
    },
    /// The recording is of another kind.
    #[error("it is a recording of the kind `{found}`, which this program cannot replay; use a newer program")]
    Kind {
        /// The kind.
        found: String,
    },
    /// The bytes are damaged.
    #[error("it is damaged: {0}; copy it again")]
    Damaged(String),
    /// The machine or the configuration cannot be used.
    #[error("its machine or configuration cannot be used: {0}")]
    Setup(#[from] SetupError),
    /// The machine does not fit the rig.
    #[error("its machine does not fit its rig: {0}")]
    Bind(#[from] BindError),
    /// The files belong to different runs.
    #[error("the files are parts of different runs; give the parts of one run")]
    OtherRun,
    /// A part is given twice.
    #[error("two of the files are part {part} of the run; give each part once")]
    Twice {
        /// Number of the part.
        part: u32,
    },
    /// The beginning is missing.
    #[error(
        "the run is recorded only from {time_s:.3} s on, and a replay needs all from its start; give the earlier parts too. \
         If they were deleted, raise `limit_mb` in the section `record` for the next run"
    )]
    NoStart {
        /// Time of the first message (s).
        time_s: f64,
    },
    /// Messages are missing in the middle.
    #[error(
        "{missing} messages of the channel `{channel}` are missing at {time_s:.3} s; give all parts of the run, or a time \
         before that"
    )]
    Gap {
        /// Topic of the channel.
        channel: &'static str,
        /// Time of the first message after the gap (s).
        time_s: f64,
        /// Number of missing messages.
        missing: u32,
    },
    /// The robot has lost records.
    #[error(
        "the robot lost {count} records before {time_s:.3} s, because its disk was too slow; only the time before that can \
         be replayed"
    )]
    Lost {
        /// Time at which the loss was noticed (s).
        time_s: f64,
        /// Number of lost records.
        count: u64,
    },
}

/// A recording that cannot be kept.
#[derive(Debug, thiserror::Error)]
pub enum KeepError {
    /// The recording cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The kept file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl From<McapError> for KeepError {
    fn from(error: McapError) -> Self {
        Self::Write(error.into())
    }
}

impl From<McapError> for ReadError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(error) => Self::Disk(error),
            McapError::BadMagic => Self::NotMcap,
            other => Self::Damaged(other.to_string()),
        }
    }
}

impl From<serde_json::Error> for ReadError {
    fn from(error: serde_json::Error) -> Self {
        Self::Damaged(error.to_string())
    }
}

impl From<ConfigError> for ReadError {
    fn from(error: ConfigError) -> Self {
        Self::Setup(error.into())
    }
}
