//! The recording of a whole run in one file.

use std::io::Write;
use std::sync::Arc;

use super::encoder::Encoder;
use super::error::WriteError;
use super::part_writer::{CHUNK, PartWriter};
use super::setup::{Origin, Setup};
use crate::drive::LoopRecord;

/// Writes a run into one file, without a limit of its size.
pub struct RecordingWriter<W: Write> {
    encoder: Encoder,
    part: PartWriter<W>,
}

impl<W: Write> RecordingWriter<W> {
    /// Begins a recording.
    ///
    /// # Errors
    /// [`WriteError`] if the output cannot be written.
    pub fn new(output: W, setup: &Setup, origin: &Origin) -> Result<Self, WriteError> {
        let identity = setup.identity(origin)?;
        Ok(Self {
            encoder: Encoder::new(Arc::clone(setup.program())),
            part: PartWriter::new(output, setup, identity, CHUNK)?,
        })
    }

    /// Adds a record of the loop.
    ///
    /// # Errors
    /// [`WriteError`] if the output cannot be written.
    pub fn take(&mut self, record: &LoopRecord) -> Result<(), WriteError> {
        if let Some(message) = self.encoder.encode(record)? {
            self.part.write(&message)?;
        }
        Ok(())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// [`WriteError`] if the output cannot be written.
    pub fn finish(self) -> Result<W, WriteError> {
        Ok(self.part.finish()?)
    }
}
