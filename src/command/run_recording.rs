//! The recording of an emulated run.

use std::collections::BTreeMap;
use std::path::Path;

use vibrissa_robot::config::Config;
use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::recording::{Origin, RecordingWriter, Setup, WriteError, program_sha256};
use vibrissa_runtime::machine::Artifact;

use super::failure::Failure;
use vibrissa_text::file::{CommandFiles, Output};

/// A recording that is written at the end of the run.
pub(super) struct RunRecording {
    file: Output,
    writer: RecordingWriter<Vec<u8>>,
    result: Result<(), WriteError>,
}

impl RunRecording {
    /// A recording into the file at `path`. `text` is the file of the configuration, if there is one. `details` describe the
    /// run.
    pub(super) fn new(
        path: &Path,
        config: &Config,
        text: Option<String>,
        artifact: &Artifact,
        details: BTreeMap<String, String>,
        files: &mut CommandFiles,
    ) -> Result<Self, Failure> {
        let file = files.output("--record", path)?;
        let setup = Setup::new(config.clone(), text, artifact.clone()).map_err(WriteError::from)?;
        let program = concat!("vibrissa ", env!("CARGO_PKG_VERSION")).to_owned();
        let origin = Origin { program, program_sha256: program_sha256(), details };
        Ok(Self { file, writer: RecordingWriter::new(Vec::new(), &setup, &origin)?, result: Ok(()) })
    }

    /// Adds a record.
    pub(super) fn take(&mut self, record: &LoopRecord) {
        if self.result.is_ok() {
            self.result = self.writer.take(record);
        }
    }

    /// Writes the file.
    pub(super) fn finish(self) -> Result<(), Failure> {
        self.result?;
        Ok(self.file.write(self.writer.finish()?)?)
    }
}
