//! Recordings of the loop, and their replay.
//!
//! A recording is one MCAP file, or several parts of one run. Each file has the machine and the configuration as
//! attachments, so that it can be replayed by itself. A metadata record `vibrissa` has their hashes and that of the program.
//!
//! | channel | content of a message, as JSON |
//! |---|---|
//! | `steps` | all inputs of one step of the control task: the rounds with the raw bytes of the registers, and the poses |
//! | `ticks` | the results of that step: state, base angles, tips, command |
//! | `events` | a change of a fault |
//! | `packets` | a packet to the actuator |
//!
//! [`replay`] executes the robot's own control task with the recorded inputs. It compares every result bit for bit.
//! [`keep`] writes a short recording for a test. [`Recorder`] is the recorder on the robot.

mod attachment;
mod channel;
mod difference;
mod directory;
mod encoder;
mod error;
mod head;
mod keep;
mod number;
mod part;
mod part_writer;
mod program_file;
mod recorder;
#[expect(clippy::module_inception, reason = "the module is named after its noun")]
mod recording;
mod records;
mod replay;
mod replay_task;
mod setup;
mod step_message;
#[cfg(test)]
mod tests;
mod tick_message;
mod writer;

pub use attachment::Attachment;
pub use difference::Difference;
pub use error::{KeepError, ReadError, WriteError};
pub use head::{FORMAT, Head};
pub use keep::{Kept, first_stop, keep};
pub use part::Part;
pub use program_file::program_sha256;
pub use recorder::{Recorder, Warn};
pub use recording::Recording;
pub use records::{FileMessage, FileRecord, Records};
pub use replay::{Replayed, replay, replay_observed};
pub use setup::{Origin, Setup, SetupError, sha256};
#[cfg(feature = "mqtt")]
pub(crate) use step_message::{PoseMessage, RoundMessage};
pub use writer::RecordingWriter;
