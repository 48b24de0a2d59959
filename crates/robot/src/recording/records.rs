//! The records of an MCAP file.

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use super::attachment::Attachment;
use super::error::ReadError;
use super::part_writer::METADATA;

/// Largest record (bytes) that is read. A damaged length must not use up the memory.
const RECORD_LIMIT: usize = 64 << 20;

/// Reads the records of a file that matter, in their order. `C` identifies the channels.
pub struct Records<R, C> {
    input: R,
    mcap: LinearReader,
    channel: fn(&str) -> Option<C>,
    channels: HashMap<u16, C>,
    is_cut: bool,
}

/// A record that matters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileRecord<C> {
    /// The metadata that identify the recording.
    Identity(BTreeMap<String, String>),
    /// An attachment.
    Attachment(Attachment),
    /// A message.
    Message(FileMessage<C>),
}

/// A message of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileMessage<C> {
    /// Its channel.
    pub channel: C,
    /// Its sequence number.
    pub sequence: u32,
    /// Its time (ns).
    pub time_ns: u64,
    /// Its content.
    pub data: Vec<u8>,
}

impl<R: Read, C: Copy> Records<R, C> {
    /// The records of a file. `channel` gives the channel with a topic, or `None` for one that does not matter.
    pub fn new(input: R, channel: fn(&str) -> Option<C>) -> Self {
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_record_length_limit(RECORD_LIMIT);
        let mcap = LinearReader::new_with_options(options);
        Self { input, mcap, channel, channels: HashMap::new(), is_cut: false }
    }

    /// True if the file has ended within a record.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// The next record that matters. `None` at the end of the file.
    ///
    /// # Errors
    /// [`ReadError`] if the file cannot be read, or if it is damaged.
    pub fn next_record(&mut self) -> Result<Option<FileRecord<C>>, ReadError> {
        while !self.is_cut {
            let (opcode, data) = match self.mcap.next_event() {
                None => return Ok(None),
                Some(Ok(LinearReadEvent::ReadRequest(count))) => {
                    let read = self.input.read(self.mcap.insert(count))?;
                    self.mcap.notify_read(read);
                    continue;
                }
                Some(Ok(LinearReadEvent::Record { opcode, data })) => (opcode, data),
                Some(Err(McapError::UnexpectedEof)) => {
                    self.is_cut = true;
                    return Ok(None);
                }
                Some(Err(error)) => return Err(error.into()),
            };
            match opcode {
                op::ATTACHMENT => return Ok(Some(FileRecord::Attachment(Attachment::parse(data)?))),
                op::METADATA | op::CHANNEL | op::MESSAGE => {}
                _ => continue,
            }
            match parse_record(opcode, data)? {
                Record::Metadata(metadata) if metadata.name == METADATA => {
                    return Ok(Some(FileRecord::Identity(metadata.metadata)));
                }
                Record::Channel(channel) => {
                    if let Some(known) = (self.channel)(&channel.topic) {
                        self.channels.insert(channel.id, known);
                    }
                }
                Record::Message { header, data } => {
                    // Another program may have added channels.
                    if let Some(&channel) = self.channels.get(&header.channel_id) {
                        let data = data.into_owned();
                        let message =
                            FileMessage { channel, sequence: header.sequence, time_ns: header.log_time, data };
                        return Ok(Some(FileRecord::Message(message)));
                    }
                }
                _ => {}
            }
        }
        Ok(None)
    }
}
