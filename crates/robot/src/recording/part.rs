//! One file of a recording.

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use super::attachment::Attachment;
use super::channel::{Channel, Message};
use super::error::ReadError;
use super::part_writer::METADATA;
use super::setup::{self, FORMAT, KIND, Setup, sha256};

/// Largest record (bytes) that is read. A damaged length must not use up the memory.
const RECORD_LIMIT: usize = 64 << 20;

/// A file of a recording. It is read up to its end, or up to the last complete chunk if its end is missing.
pub struct Part<R> {
    setup: Setup,
    items: Items<R>,
    identity: BTreeMap<String, String>,
    /// The first message, which was read to find the end of the header.
    first: Option<Message>,
}

/// The records of a file that matter.
struct Items<R> {
    input: R,
    mcap: LinearReader,
    channels: HashMap<u16, Channel>,
    is_cut: bool,
}

/// A record that matters.
enum Item {
    Identity(BTreeMap<String, String>),
    Attachment(Attachment),
    Message(Message),
}

impl<R: Read> Part<R> {
    /// Reads the header of a file.
    ///
    /// # Errors
    /// [`ReadError`] if it is no recording that this program can replay.
    pub fn open(input: R) -> Result<Self, ReadError> {
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_record_length_limit(RECORD_LIMIT);
        let mcap = LinearReader::new_with_options(options);
        let mut items = Items { input, mcap, channels: HashMap::new(), is_cut: false };
        let (mut identity, mut attachments, mut first) = (None, HashMap::new(), None);
        while first.is_none()
            && let Some(item) = items.next_item()?
        {
            match item {
                Item::Identity(entries) => identity = Some(entries),
                Item::Attachment(Attachment { name, data }) => {
                    attachments.insert(name, data);
                }
                Item::Message(message) => first = Some(message),
            }
        }
        let identity = match (identity, items.is_cut) {
            (Some(identity), _) => identity,
            (None, true) => return Err(ReadError::Empty),
            (None, false) => return Err(ReadError::Foreign),
        };
        check(&identity)?;
        let setup = read_setup(attachments, &identity)?;
        Ok(Self { setup, items, identity, first })
    }

    /// The machine and the configuration.
    pub(super) fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The metadata.
    pub(super) fn identity(&self) -> &BTreeMap<String, String> {
        &self.identity
    }

    /// True if the end of the file is missing. It is known once all messages have been read.
    pub(super) fn is_cut(&self) -> bool {
        self.items.is_cut
    }

    /// The next message.
    pub(super) fn next_message(&mut self) -> Result<Option<Message>, ReadError> {
        if let Some(message) = self.first.take() {
            return Ok(Some(message));
        }
        while let Some(item) = self.items.next_item()? {
            if let Item::Message(message) = item {
                return Ok(Some(message));
            }
        }
        Ok(None)
    }
}

/// Checks that this program can replay the recording.
fn check(identity: &BTreeMap<String, String>) -> Result<(), ReadError> {
    let entry = |key: &str| identity.get(key).cloned().unwrap_or_default();
    match (entry("kind"), entry("format")) {
        (kind, _) if kind != KIND => Err(ReadError::Kind { found: kind }),
        (_, format) if format != FORMAT => Err(ReadError::Format { found: format }),
        _ => Ok(()),
    }
}

/// The setup in the attachments. Their hashes are compared with the metadata.
fn read_setup(
    mut attachments: HashMap<String, Vec<u8>>,
    identity: &BTreeMap<String, String>,
) -> Result<Setup, ReadError> {
    let mut take = |name: &str| {
        let Some(content) = attachments.remove(name) else { return Ok(None) };
        if identity.get(&format!("{name}_sha256")) == Some(&sha256(&content)) {
            Ok(Some(content))
        } else {
            Err(ReadError::Damaged(format!("the attachment `{name}` has another hash than the metadata say")))
        }
    };
    let machine = take(setup::MACHINE.0)?.ok_or(ReadError::Empty)?;
    let configuration = take(setup::CONFIGURATION.0)?.ok_or(ReadError::Empty)?;
    let text = take(setup::CONFIGURATION_TEXT.0)?.and_then(|text| String::from_utf8(text).ok());
    Ok(Setup::from_attachments(machine, configuration, text)?)
}

impl<R: Read> Items<R> {
    /// The next record that matters.
    fn next_item(&mut self) -> Result<Option<Item>, ReadError> {
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
                op::ATTACHMENT => return Ok(Some(Item::Attachment(Attachment::parse(data)?))),
                op::METADATA | op::CHANNEL | op::MESSAGE => {}
                _ => continue,
            }
            match parse_record(opcode, data)? {
                Record::Metadata(metadata) if metadata.name == METADATA => {
                    return Ok(Some(Item::Identity(metadata.metadata)));
                }
                Record::Channel(channel) => {
                    if let Some(known) = Channel::of(&channel.topic) {
                        self.channels.insert(channel.id, known);
                    }
                }
                Record::Message { header, data } => {
                    // Another program may have added channels.
                    if let Some(&channel) = self.channels.get(&header.channel_id) {
                        let data = data.into_owned();
                        let message = Message { channel, sequence: header.sequence, time_ns: header.log_time, data };
                        return Ok(Some(Item::Message(message)));
                    }
                }
                _ => {}
            }
        }
        Ok(None)
    }
}
