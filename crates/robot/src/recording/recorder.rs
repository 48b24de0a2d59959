//! The recording on the robot.

use std::collections::BTreeMap;
use std::fs::File;
use std::sync::Arc;

use super::channel::{Channel, Message};
use super::directory::{Directory, PartName};
use super::encoder::Encoder;
use super::error::WriteError;
use super::part_writer::{CHUNK, PartWriter};
use super::setup::{Origin, PART, Setup};
use crate::config::RecordConfig;
use crate::drive::{LoopRecord, RecordSink};
use crate::vitals::Vitals;

/// Parts that fit into the limit. The oldest part is deleted when the next one begins.
const PARTS: u64 = 8;
/// Chunks of a small part.
const CHUNKS: u64 = 8;
/// Size (bytes) of a part beside the setup, for schemas and some messages.
const LEAST_BYTES: u64 = 64 << 10;
/// Time (ns) after a failure until the disk is tried again.
const RETRY_NS: u64 = 10_000_000_000;

/// Records a run into files of a directory with a limited size.
///
/// A failure of the disk is a warning. The recording is tried again every ten seconds, with a gap.
pub struct Recorder {
    directory: Directory,
    setup: Setup,
    identity: BTreeMap<String, String>,
    encoder: Encoder,
    part: Option<Part>,
    /// Name of the next part, once the directory is known.
    next: Option<PartName>,
    now_ns: u64,
    /// Time (ns) of the next attempt, if the disk has failed.
    retry_ns: Option<u64>,
    warn: Warn,
}

/// A receiver of warnings.
pub type Warn = Box<dyn FnMut(&str) + Send>;

/// A file that is written.
struct Part {
    writer: PartWriter<File>,
    /// The same file, to synchronise it.
    file: File,
    /// Bytes in the file.
    written: u64,
    chunks: u64,
    has_event: bool,
}

impl Recorder {
    /// A recorder of a run, which begins with the first record.
    ///
    /// # Errors
    /// [`WriteError::Setup`] if the setup cannot be written, and [`WriteError::Limit`] if it does not fit into a file.
    pub fn new(record: &RecordConfig, setup: Setup, origin: &Origin, warn: Warn) -> Result<Self, WriteError> {
        let limit_bytes = record.limit_mb.saturating_mul(1_000_000);
        let setup_bytes: usize = setup.attachments().map(|(_, content)| content.len()).sum();
        if setup_bytes as u64 + LEAST_BYTES > limit_bytes / PARTS {
            return Err(WriteError::Limit { limit_bytes });
        }
        Ok(Self {
            directory: Directory::new(record.directory.clone(), limit_bytes),
            identity: setup.identity(origin)?,
            encoder: Encoder::new(Arc::clone(setup.program())),
            setup,
            part: None,
            next: None,
            now_ns: 0,
            retry_ns: None,
            warn,
        })
    }

    /// The largest size (bytes) of a part.
    fn part_bytes(&self) -> u64 {
        self.directory.limit_bytes() / PARTS
    }

    fn record(&mut self, record: &LoopRecord) -> Result<(), WriteError> {
        // The message is counted, even if it is not written. So a reader sees the gap.
        let Some(message) = self.encoder.encode(record)? else { return Ok(()) };
        if self.retry_ns.is_some_and(|retry_ns| self.now_ns < retry_ns) {
            return Ok(());
        }
        let (part_bytes, size) = (self.part_bytes(), PartWriter::<File>::size_of(&message));
        let mut part = match self.part.take() {
            Some(part) if part.worst_bytes(size) <= part_bytes => part,
            Some(part) => {
                part.finish()?;
                self.begin()?
            }
            None => self.begin()?,
        };
        if part.worst_bytes(size) > part_bytes {
            return Err(WriteError::Limit { limit_bytes: self.directory.limit_bytes() });
        }
        part.write(&message)?;
        self.part = Some(part);
        if self.retry_ns.take().is_some() {
            (self.warn)("the recording goes on, with a gap");
        }
        Ok(())
    }

    /// Begins the next part.
    fn begin(&mut self) -> Result<Part, WriteError> {
        let name = match self.next {
            Some(name) => name,
            None => PartName { run: self.directory.next_run()?, part: 0 },
        };
        let part_bytes = self.part_bytes();
        self.directory.make_room(part_bytes)?;
        let file = self.directory.create(name)?;
        self.next = Some(PartName { part: name.part.saturating_add(1), ..name });
        let mut identity = self.identity.clone();
        identity.insert(PART.to_owned(), name.part.to_string());
        let chunk = usize::try_from(part_bytes / CHUNKS).unwrap_or(CHUNK).min(CHUNK);
        let part = Part::begin(file, &self.setup, identity, chunk);
        if part.is_err() {
            // It has no complete header, so nobody can use it. The first error is the one to report.
            let _ = self.directory.remove(name);
        }
        part
    }

    fn flush(&mut self) -> Result<(), WriteError> {
        let Some(part) = &mut self.part else { return Ok(()) };
        if part.has_event { part.flush() } else { Ok(()) }
    }

    fn end(&mut self) -> Result<(), WriteError> {
        self.part.take().map_or(Ok(()), Part::finish)
    }

    /// Reports a failure once, and closes the file.
    fn check(&mut self, result: Result<(), WriteError>) {
        let Err(error) = result else { return };
        self.part = None;
        if self.retry_ns.replace(self.now_ns.saturating_add(RETRY_NS)).is_none() {
            let directory = self.directory.path().display();
            let message = format!("the recording in {directory} has stopped, and is tried again: {error}");
            (self.warn)(&message);
        }
    }
}

impl RecordSink for Recorder {
    fn take(&mut self, record: &LoopRecord) {
        let result = self.record(record);
        self.check(result);
    }

    fn pause(&mut self, now_ns: u64, _vitals: &Vitals) {
        self.now_ns = now_ns;
        let result = self.flush();
        self.check(result);
    }

    fn finish(&mut self) {
        let result = self.end();
        self.check(result);
    }
}

impl Part {
    fn begin(file: File, setup: &Setup, identity: BTreeMap<String, String>, chunk: usize) -> Result<Self, WriteError> {
        let writer = PartWriter::new(file.try_clone()?, setup, identity, chunk)?;
        let written = file.metadata()?.len();
        Ok(Self { writer, file, written, chunks: 0, has_event: false })
    }

    fn write(&mut self, message: &Message) -> Result<(), WriteError> {
        self.has_event |= message.channel == Channel::Events;
        if self.writer.write(message)? { self.synchronise() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), WriteError> {
        self.writer.flush()?;
        self.synchronise()
    }

    /// Waits until the disk has the chunk, so that it survives a loss of power.
    fn synchronise(&mut self) -> Result<(), WriteError> {
        self.file.sync_data()?;
        self.written = self.file.metadata()?.len();
        self.chunks += 1;
        self.has_event = false;
        Ok(())
    }

    fn finish(self) -> Result<(), WriteError> {
        Ok(self.writer.finish()?.sync_all()?)
    }

    /// An upper bound of the size (bytes) of the complete file with a further message of this size.
    fn worst_bytes(&self, message: usize) -> u64 {
        let schemas: usize = Channel::ALL.iter().map(|channel| channel.schema().len()).sum();
        let pending = (self.writer.pending() + message) as u64;
        // Compression of random bytes makes them a little longer. The summary has the schemas and an entry per chunk.
        let chunk = pending + pending / 128 + 1024;
        let summary = schemas as u64 + 2048 + 256 * (self.chunks + 1);
        self.written + chunk + summary
    }
}
