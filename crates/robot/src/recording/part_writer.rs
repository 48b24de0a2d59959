//! The writer of one MCAP file.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, McapError, WriteOptions, Writer};

use super::channel::{Channel, Message};
use super::setup::Setup;

/// Name of the metadata record.
pub(super) const METADATA: &str = "vibrissa";
/// Uncompressed size (bytes) after which a chunk is written: about a second of a run.
pub(super) const CHUNK: usize = 256 << 10;
/// Bytes of a message beside its content, in the chunk and in the index.
const OVERHEAD: usize = 64;

/// Writes one MCAP file. Its chunks are complete or absent, because each is written at once.
pub(super) struct PartWriter<W: Write> {
    mcap: Writer<NoSeek<W>>,
    channels: [u16; Channel::ALL.len()],
    /// Uncompressed size (bytes) of the chunk that has not been written.
    pending: usize,
    chunk: usize,
}

impl<W: Write> PartWriter<W> {
    /// Writes the metadata and the attachments. A chunk has about `chunk` bytes before its compression.
    pub(super) fn new(
        output: W,
        setup: &Setup,
        identity: BTreeMap<String, String>,
        chunk: usize,
    ) -> Result<Self, McapError> {
        let options = WriteOptions::new()
            .profile("vibrissa")
            .library(concat!("vibrissa/", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            // Without threads: the loop needs the processors.
            .compression_threads(0)
            .chunk_size(None)
            .disable_seeking(true);
        let mut mcap = options.create(NoSeek::new(output))?;
        mcap.write_metadata(&Metadata { name: METADATA.to_owned(), metadata: identity })?;
        for ((name, media_type), content) in setup.attachments() {
            mcap.attach(&Attachment {
                log_time: 0,
                create_time: 0,
                name: name.to_owned(),
                media_type: media_type.to_owned(),
                data: Cow::Borrowed(content),
            })?;
        }
        let mut channels = [0; Channel::ALL.len()];
        let mut pending = 0;
        for (channel, id) in Channel::ALL.into_iter().zip(&mut channels) {
            let schema = mcap.add_schema(channel.schema_name(), "jsonschema", channel.schema().as_bytes())?;
            *id = mcap.add_channel(schema, channel.topic(), "json", &BTreeMap::new())?;
            pending += channel.schema().len() + OVERHEAD;
        }
        Ok(Self { mcap, channels, pending, chunk })
    }

    /// Adds a message. It writes the chunk once it is large enough, and then the result is true.
    pub(super) fn write(&mut self, message: &Message) -> Result<bool, McapError> {
        let header = MessageHeader {
            channel_id: self.channels.get(message.channel.index()).copied().unwrap_or_default(),
            sequence: message.sequence,
            log_time: message.time_ns,
            publish_time: message.time_ns,
        };
        self.mcap.write_to_known_channel(&header, &message.data)?;
        self.pending += Self::size_of(message);
        let is_full = self.pending >= self.chunk;
        if is_full {
            self.flush()?;
        }
        Ok(is_full)
    }

    /// Writes the chunk.
    pub(super) fn flush(&mut self) -> Result<(), McapError> {
        self.mcap.flush()?;
        self.pending = 0;
        Ok(())
    }

    /// Uncompressed size (bytes) of the chunk that has not been written, with its index.
    pub(super) fn pending(&self) -> usize {
        self.pending
    }

    /// Uncompressed size (bytes) of a message in a chunk, with its index.
    pub(super) fn size_of(message: &Message) -> usize {
        message.data.len() + OVERHEAD
    }

    /// Writes the last chunk and the summary.
    pub(super) fn finish(mut self) -> Result<W, McapError> {
        self.mcap.finish()?;
        Ok(self.mcap.into_inner().into_inner())
    }
}
