//! Recordings of simulated runs: MCAP files that viewers open, and that are replayed bit by bit.
//!
//! A recording contains the samples of every tick, the compiled machine and the rig that control assumes. So it can be replayed
//! without the simulator.

mod channel;
mod channels;
mod error;
mod frame;
mod read;
mod recorder;
mod replay;
mod sample_message;
mod sampled_run;
mod sampled_world;
mod setup;
mod view;
mod writer;

pub use error::{ReadRecordingError, RecordError};
pub use read::RunRecording;
pub use recorder::Recorder;
pub use replay::{compare_policies, replay};
pub use sampled_run::{SampledRun, record_samples};
pub use setup::Setup;
pub use {channels::Channels, frame::RecordedFrame};
